// Leak-off of a fluid from open fractures into the rock.
#pragma once

#include "transport/fracture_flow.hpp"

#include <memory>
#include <vector>

namespace sprekk::transport {

/// Creates the module of leak-off (Carter 1957). The resistance of the rock to a face's loss grows with the volume V
/// per area that the face has lost through both sides:
///   dV/dt = s 8 C_L^2/V,   s = min(1, a/a_min)
/// An open face, s = 1, loses V = 4 C_L sqrt(t - t_0) since its exposure at t_0, exactly in steps of any length. With a
/// widening, s is that of the mechanical aperture a >= 0 without lower bound at the end of the step, and of the
/// residual aperture a_min: closed faces lose no fluid. t_0 is the start of the run or of the stage; for bonded faces,
/// it is the middle of the step in which they open. Volumes are those at the reference pressure.
///
/// The loss is added to the rows of "face pressure" like an increase of storage, so the balance is exact in all time
/// schemes. Outputs: "leaked fluid" V (faces, m), its integral "leaked volume", and "exposure time" (V/4 C_L)^2 (faces,
/// s). Totals: inflow "leak-off", negative, mean rate of the last step.
///
/// `faces`: [local fracture face]. `widens`: apertures depend on "widening" of FractureOpening.
std::unique_ptr<assembly::Module> make_leak_off(std::vector<FractureFlowParameters::Face> faces, bool widens);

}  // namespace sprekk::transport
