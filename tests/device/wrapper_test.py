#!/usr/bin/env python3
"""Tests the build of the kernels with an nvcc_wrapper whose default architecture is unknown to nvcc:
wrapper_test.py ROOT CMAKE KOKKOS

KOKKOS is the folder with KokkosConfig.cmake. A mock of nvcc accepts one architecture, at least sm_75."""
import subprocess
import sys
import tempfile
from pathlib import Path

WRAPPER = """#!/usr/bin/env bash
left=() n=0 arch=sm_70
for word; do
  case $word in -arch=*) arch=${word#-arch=} n=$((n + 1)) ;; --expt*) ;; *) left+=("$word") ;; esac
done
((n <= 1)) || { echo "nvcc fatal: redefinition of argument 'gpu-architecture'"; exit 1; }
((${arch#sm_} >= 75)) || { echo "nvcc fatal: Unsupported gpu architecture '$arch'"; exit 1; }
exec g++ "${left[@]}"
"""


def main():
    root, cmake, kokkos = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        wrapper = Path(name) / "nvcc_wrapper"
        wrapper.write_text(WRAPPER)
        wrapper.chmod(0o755)
        words = [cmake, "-S", root + "/tests/device", f"-DKokkos_DIR={kokkos}", f"-DCMAKE_CXX_COMPILER={wrapper}", "-DCMAKE_CXX_FLAGS=-DMINE"]
        done = subprocess.run([*words, "-B", name + "/build"], capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
        flags = (Path(name) / "build/CMakeFiles/kernels_device.dir/flags.make").read_text()
        assert "-DMINE" in flags and "-arch=" not in flags, flags  # Kokkos adds the architecture of the kernels
        done = subprocess.run([*words, "-B", name + "/old", "-DSPREKK_CUDA_ARCH=sm_70"], capture_output=True, text=True)
        assert done.returncode != 0 and "sm_70" in done.stdout + done.stderr, done.stdout + done.stderr


if __name__ == "__main__":
    main()
