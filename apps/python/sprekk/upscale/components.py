"""Tensors in components: stresses and strains as vectors, rotations, principal values, order of bounds.

Vectors have the order xx, yy, zz, yz, xz, xy (2D: xx, yy, xy). Shear strains are 2 e_ij, so that the product of stress
and strain is the work."""
import numpy as np

PAIRS = {2: [(0, 0), (1, 1), (0, 1)], 3: [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)]}
AXES = "xyz"


def names(dim):
    """Returns the names of the components of a symmetric tensor, such as "xy"."""
    return [AXES[i] + AXES[j] for i, j in PAIRS[dim]]


def n_components(dim):
    return len(PAIRS[dim])


def unit_stresses(dim):
    """Returns the symmetric matrices [component, dim, dim] of unit stresses."""
    units = np.zeros((n_components(dim), dim, dim))
    for k, (i, j) in enumerate(PAIRS[dim]):
        units[k, i, j] = units[k, j, i] = 1
    return units


def unit_strains(dim):
    """Returns the symmetric matrices [component, dim, dim] of unit strains; shear strains are 2 e_ij."""
    units = unit_stresses(dim)
    units[dim:] /= 2
    return units


def matrix_of(stress):
    """Returns the matrix of a stress given as a vector, or of any symmetric tensor without factors 2."""
    dim = 2 if len(stress) == 3 else 3
    return np.einsum("k,kij->ij", stress, unit_stresses(dim))


def vector_of(matrix):
    """Returns the vector of a symmetric matrix, without factors 2."""
    dim = len(matrix)
    return np.array([(matrix[i, j] + matrix[j, i]) / 2 for i, j in PAIRS[dim]])


def rotated(tensor, R):
    """Returns a tensor in turned axes: [dim, dim] as R k R^T, or a compliance [component, component] as Q S Q^T.

    Q maps strain vectors, e' = R e R^T."""
    dim = len(R)
    if len(tensor) == dim:
        return R @ tensor @ R.T
    Q = np.array([[np.sum((R @ unit @ R.T) * test) for unit in unit_strains(dim)] for test in unit_stresses(dim)])
    return Q @ tensor @ Q.T


def principal(tensor):
    """Returns the principal values, largest first, and the directions as rows, of the symmetric part of [dim, dim]."""
    values, vectors = np.linalg.eigh((tensor + tensor.T) / 2)
    return values[::-1], vectors.T[::-1]


def of_inverse(inverse, error):
    """Returns a bound of the error of an inverse, |A^-1| dA |A^-1|, to first order; None without dA."""
    return None if error is None else abs(inverse) @ error @ abs(inverse)


def asymmetry(tensor):
    """Returns the norm of the antisymmetric part, relative to the tensor."""
    return float(np.linalg.norm(tensor - tensor.T) / 2 / max(np.linalg.norm(tensor), 1e-300))


def excess(lower, upper):
    """Returns the largest eigenvalue of lower - upper, relative to the largest of upper; not positive if ordered."""
    symmetric = [(t + t.T) / 2 for t in (lower, upper)]
    largest = max(np.linalg.eigvalsh(symmetric[1])[-1], 1e-300)
    return float(np.linalg.eigvalsh(symmetric[0] - symmetric[1])[-1] / largest)


def largest_ratio(lower, upper):
    """Returns the largest ratio of the quadratic forms of upper and lower, both symmetric and positive."""
    symmetric = [(t + t.T) / 2 for t in (lower, upper)]
    values, vectors = np.linalg.eigh(symmetric[0])
    if values[0] <= 0:
        return float("inf")
    half = vectors / np.sqrt(values)
    return float(np.linalg.eigvalsh(half.T @ symmetric[1] @ half)[-1])
