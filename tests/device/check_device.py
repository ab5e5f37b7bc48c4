#!/usr/bin/env python3
"""Compiles the kernels of packages/assembly, transport and physics, and their laws, for a GPU, without execution.

    check_device.py ROOT [--for hip|cuda] [--kokkos CHECKOUT] [FILE...]
        all files with kernels, or the given ones; exit status 1: errors, 77: skipped

hip:  clang -fsyntax-only, device code only. Requires clang 19 or later (SPREKK_CLANG names another) and the headers of
      HIP: Debian's clang-19, hipcc, libamdhip64-dev, rocm-device-libs.
cuda: nvcc, which also generates device code. Requires version 12 or later. It checks rules of CUDA that clang ignores:
      no kernel as a lambda in a private member or in a function template for a lambda, no host variable in device code.
      If nvcc crashes, the file is reported, but not as an error.

Both use the installed headers of Trilinos, with a Kokkos (3.4) for the host only. Modified copies of some configuration
headers select the back end of the GPU during the check.

With --kokkos (or SPREKK_KOKKOS), hip also compiles the programs in this folder with a checkout of a later Kokkos. They
need only Sacado from Trilinos."""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

TRILINOS = Path(os.environ.get("SPREKK_TRILINOS_INCLUDE", "/usr/include/trilinos"))
HAS_KERNELS = re.compile(r"\bKOKKOS_LAMBDA\b|\bAssembler<|\bKernelModule\b|\bmake_kernel_module\b|\bTerm\b|\bparallel_\w+")
BACK_ENDS = {  # back end: (name in header paths, name of its setup header, settings of Kokkos)
    "hip": ("HIP", "HIP", ["HIP", "ARCH_VEGA906"]),
    "cuda": ("CUDA", "Cuda", ["CUDA", "CUDA_LAMBDA", "CUDA_UVM", "CUDA_CONSTEXPR", "ARCH_AMPERE", "ARCH_AMPERE80"]),
}


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def switched_on(text, names):
    for name in names:
        text = re.sub(rf"/\* #undef {name} \*/", f"#define {name}", text)
        if f"#define {name}\n" not in text:
            text += f"\n#define {name}\n"
    return text


def overlay(folder, back_end):
    """Writes copies of configuration headers with the back end enabled."""
    name, folder_name, settings = BACK_ENDS[back_end]
    read = lambda header: (TRILINOS / header).read_text()
    names = ["KOKKOS_" + ("" if s.startswith("ARCH") else "ENABLE_") + s for s in settings]
    config = read("KokkosCore_config.h").replace("#define KOKKOS_ENABLE_CXX14", "")
    (folder / "KokkosCore_config.h").write_text(switched_on(config, ["KOKKOS_ENABLE_CXX17", *names]))
    for header, include in [("DeclareBackend", f"decl/Kokkos_Declare_{name}"), ("FwdBackend", f"fwd/Kokkos_Fwd_{name}"),
                            ("SetupBackend", f"setup/Kokkos_Setup_{folder_name}")]:
        text = read(f"KokkosCore_Config_{header}.hpp")
        at = text.rindex("#endif")
        (folder / f"KokkosCore_Config_{header}.hpp").write_text(
            text[:at] + f"#include <{include}.hpp>\n" + text[at:])
    tpetra = switched_on(read("TpetraCore_config.h"), [f"HAVE_TPETRA_INST_{name}", f"HAVE_TPETRA_{name}"])
    (folder / "TpetraCore_config.h").write_text(tpetra)
    if back_end == "cuda":  # types of half precision use functions that CUDA has removed
        (folder / "Cuda").mkdir()
        (folder / "Cuda/Kokkos_Cuda_Half.hpp").write_text("")


def overlay_checkout(folder, kokkos):
    """Writes the configuration of CMake for a checkout of Kokkos 4 with HIP; returns the include folders."""
    found = dict(re.findall(r"set\(Kokkos_VERSION_(\w+) (\d+)\)", (kokkos / "CMakeLists.txt").read_text()))
    version = [int(found[part]) for part in ("MAJOR", "MINOR", "PATCH")]
    settings = ["CORE_CONFIG_H", f"VERSION {version[0] * 10000 + version[1] * 100 + version[2]}",
                *(f"VERSION_{part} {number}" for part, number in zip(("MAJOR", "MINOR", "PATCH"), version)),
                "ENABLE_SERIAL", "ENABLE_HIP", "ENABLE_CXX20", "ENABLE_IMPL_MDSPAN", "ARCH_AMD_GFX90A", 'ARCH_AMD_GPU "GFX90A"']
    (folder / "KokkosCore_config.h").write_text("".join(f"#define KOKKOS_{setting}\n" for setting in settings))
    for header, names in [("DeclareBackend", ("decl/Kokkos_Declare_SERIAL", "decl/Kokkos_Declare_HIP")),
                          ("FwdBackend", ("fwd/Kokkos_Fwd_SERIAL", "fwd/Kokkos_Fwd_HIP")),
                          ("SetupBackend", ("setup/Kokkos_Setup_HIP",))]:
        (folder / f"KokkosCore_Config_{header}.hpp").write_text("".join(f"#include <{name}.hpp>\n" for name in names))
    (folder / "desul/atomics").mkdir(parents=True)
    (folder / "desul/atomics/Config.hpp").write_text("#define DESUL_ATOMICS_ENABLE_HIP\n")
    (folder / "sacado").mkdir()
    for header in TRILINOS.glob("Sacado*"):  # without the headers of Kokkos in the same folder
        shutil.copy(header, folder / "sacado")
    return [folder, *(kokkos / part for part in ("core/src", "containers/src", "tpls/desul/include", "tpls/mdspan/include")),
            Path(__file__).parent / "sacado", folder / "sacado"]


def compile_all(command, files, back_end):
    """Compiles the files; returns whether there were no errors."""
    wrong, crashed = [], []
    for file in files:
        done = subprocess.run([*command, str(file)], capture_output=True, text=True)
        output = done.stdout + done.stderr
        errors = sorted({line for line in output.splitlines() if re.search(r"\berror\b", line)})
        if done.returncode and ("Segmentation fault" in output or "PLEASE submit a bug report" in output):
            crashed.append(file)
        elif done.returncode:
            wrong.append(file)
            print(f"{file}:\n  " + "\n  ".join(errors[:10] or output.splitlines()[-10:]), flush=True)
    for file in crashed:
        print(f"{file}: the compiler crashed")
    print(f"{back_end}: {len(files)} files, {len(wrong)} with errors, {len(crashed)} where the compiler crashed", flush=True)
    return not wrong


def first_of(*names):
    for name in names:
        if name and shutil.which(name):
            return shutil.which(name)
    return None


def compiler(back_end):
    """Returns the compiler command without include folders and files."""
    if back_end == "cuda":
        nvcc = first_of("nvcc", "/usr/local/cuda/bin/nvcc")
        if not nvcc:
            skip("no nvcc")
        return [nvcc, "-x", "cu", "-cuda", "-o", os.devnull, "-arch=sm_80", "--expt-extended-lambda",
                "--expt-relaxed-constexpr", "-DFMT_CONSTEVAL="]  # fmt: nvcc reports its compile-time checks as errors
    clang = first_of(os.environ.get("SPREKK_CLANG"), "clang++-19", "clang++-20")
    device_library = next(iter(sorted(Path("/usr/lib").glob("*/amdgcn/bitcode"))), None)
    if not clang:
        skip("no clang++-19; SPREKK_CLANG names another")
    if not Path("/usr/include/hip/hip_runtime.h").exists() or not device_library:
        skip("no headers of HIP: apt install libamdhip64-dev rocm-device-libs hipcc")
    return [clang, "-x", "hip", "--offload-arch=gfx906", "--rocm-path=/usr",
            f"--rocm-device-lib-path={device_library}", "--cuda-device-only", "-fsyntax-only"]


def mpi_includes():
    words = subprocess.run(["mpicxx", "--showme:incdirs"], capture_output=True, text=True)
    return words.stdout.split() if words.returncode == 0 else []


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("root", type=Path)
    parser.add_argument("--for", dest="back_end", choices=BACK_ENDS, default="hip")
    parser.add_argument("--kokkos", type=Path, default=os.environ.get("SPREKK_KOKKOS"), help="a checkout of Kokkos 4")
    parser.add_argument("files", nargs="*", type=Path)
    arguments = parser.parse_intermixed_args()
    packages = arguments.root / "packages"
    if not (TRILINOS / "KokkosCore_config.h").exists():
        skip(f"no Kokkos in {TRILINOS}; SPREKK_TRILINOS_INCLUDE names another folder")
    if arguments.kokkos and not (Path(arguments.kokkos) / "core/src/Kokkos_Core.hpp").exists():
        sys.exit(f"{arguments.kokkos}: no checkout of Kokkos")
    files = arguments.files or [f for package in ("assembly", "transport", "physics") for f in sorted(packages.glob(f"{package}/**/*.cpp"))
                                if HAS_KERNELS.search(f.read_text())]
    command = compiler(arguments.back_end) + ["-std=c++20", "-w", "-DFMT_SHARED", f"-I{packages}"]
    with tempfile.TemporaryDirectory() as name:
        overlay(Path(name), arguments.back_end)
        includes = [f"-I{name}"]
        for folder in [str(TRILINOS), *mpi_includes()]:
            includes += ["-isystem", folder]
        good = compile_all(command + includes, files, arguments.back_end)
    if arguments.kokkos and arguments.back_end == "hip":
        with tempfile.TemporaryDirectory() as name:
            includes = [f"-I{folder}" for folder in overlay_checkout(Path(name), Path(arguments.kokkos))]
            here = Path(__file__).parent
            good = compile_all(command + includes, [here / "cells.cpp", here / "faces.cpp"], "hip, the checkout") and good
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
