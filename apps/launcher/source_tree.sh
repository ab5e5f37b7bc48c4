# Commands of the launcher that require the source tree; `sprekk` reads this file there.

cmake_options=()
packages=(g++ cmake ninja-build ccache lld python3
  trilinos-all-dev libscotch-dev libptscotch-dev libopenmpi-dev openmpi-bin libmetis-dev libmumps-dev
  libopenblas0-serial libmuparser-dev libhdf5-openmpi-dev zlib1g-dev libfmt-dev nlohmann-json3-dev libcli11-dev
  libvtk9-dev libgtest-dev libgmock-dev libxml2-utils pybind11-dev libpython3-dev)
peer_packages=(python3-{scipy,numba,networkx,shapely,sympy,meshio,h5py,gmsh,tqdm,typing-extensions,requests,deepdiff,jinja2}
  python3-{pytest,seaborn,psutil,future,six,pandas,petsc4py-real})  # dependencies of PorePy
viewer_packages=(nodejs npm)  # for the 3D view of reports, bundled once
docs_packages=(mkdocs mkdocs-material libjs-katex doxygen)
package_packages=(dpkg-dev file git python3-pip)
test_packages=(gmsh python3-{xarray,h5netcdf,sympy})  # for tests of the documentation, of probes and of measurements

# Writes the output of configure_and_build to the log and shows the progress. A terminal gets one updated line with an
# estimate of the remaining time. Otherwise a line is printed at the first file and after each tenth of the build.
show_progress() {
  local line begin=$SECONDS passed n all tenth=-1 left
  while IFS= read -r line; do
    printf '%s\n' "$line" >>"$build/build.log"
    if [[ $line == sprekk:* ]]; then echo "$line" >&2; fi
    if [[ $line == ninja:\ Entering* ]]; then begin=$SECONDS; fi
    [[ $line =~ ^\[([1-9][0-9]*)/([0-9]+)\]\  && $line != *Re-checking* ]] || continue
    n=${BASH_REMATCH[1]} all=${BASH_REMATCH[2]} passed=$((SECONDS - begin)) left=
    if [[ -t 2 ]]; then
      if ((passed >= 10)); then left=", about $((passed * (all - n) / n / 60 + 1)) min left"; fi
      printf '\rsprekk: building %s of %s%s\e[K' "$n" "$all" "$left" >&2
    elif ((10 * n / all != tenth)); then
      say "building $n of $all"
    fi
    tenth=$((10 * n / all))
  done
  if ((tenth >= 0)) && [[ -t 2 ]]; then printf '\r\e[K' >&2; fi
}

configure_and_build() {
  : >"$build/build.log"
  if [[ -f $build/CMakeCache.txt ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$build/CMakeCache.txt"; then
    rm -rf "$build/CMakeCache.txt" "$build/CMakeFiles" "$build/build.ninja"  # the tree was moved or copied
  fi
  if [[ ! -f $build/build.ninja ]]; then
    say "configuring"
    cmake -S "$root" -B "$build" -G Ninja "${cmake_options[@]}" || return
  fi
  local gib jobs; jobs=$(env -u OMP_NUM_THREADS nproc)  # nproc depends on OMP_NUM_THREADS
  gib=$(awk '/^MemAvailable/ {print int($2 / 1048576)}' /proc/meminfo)
  ((jobs = jobs * 2 > gib ? (gib > 1 ? gib / 2 : 1) : jobs))  # a translation unit needs up to 2 GiB
  ninja -C "$build" -j "$jobs" "$@"
}

# build TARGETS...: updates the targets. Prints nothing if they are up to date, and compiler errors if it fails.
build() {
  install_missing "${packages[@]}"
  if ! { mkdir -p "$build" && : >>"$build/.lock"; } 2>/dev/null; then
    local owner; owner=$(stat -c %U "$build" 2>/dev/null || stat -c %U "$root")
    say "$build cannot be written; it belongs to $owner"
    say "run that build's program itself, $binary, or copy the tree to a folder of your own and build there"
    exit 1
  fi
  if ! { flock -n 9 || { say "waiting for another build in $build"; flock 9; }; configure_and_build "$@" 2>&1 9>&- | show_progress; } 9>"$build/.lock"; then
    sed -n '/^FAILED\|CMake Error\|^ninja: error/,$p' "$build/build.log" | head -n 60 >&2
    say "the build failed, its log is $build/build.log"
    exit 1
  fi
}

# run_tests [--fast] [ctest options]: runs the tests.
run_tests() {
  local words=() word
  for word; do if [[ $word == --fast ]]; then words+=(-L fast); else words+=("$word"); fi; done
  [[ " $* " != *" -L packages "* ]] || words+=(-C packages)  # not among the tests otherwise
  exec ctest --test-dir "$build" --output-on-failure -j2 "${words[@]}"
}

# For the tests of reports and of the web site: a browser and npm, unless others are on the path.
install_browser() {
  local browser
  command -v npm >/dev/null || install_missing "${viewer_packages[@]}"
  for browser in chromium-headless-shell chromium chromium-browser google-chrome; do
    if command -v "$browser" >/dev/null; then return; fi
  done
  install_missing chromium-headless-shell
}

# fuzz [N]: the readers on damaged files; status 1 if one of them crashes or misbehaves.
fuzz() {
  local n=${1-10000} status=0
  [[ $# -le 1 && $n =~ ^[1-9][0-9]{0,8}$ ]] || usage_error "fuzz takes a positive whole number, got \"$*\""
  build=$root/build/sanitized cmake_options=(-DSPREKK_SANITIZE=ON)
  build fuzz_msh fuzz_scene
  export ASAN_OPTIONS=detect_leaks=0  # Open MPI has leaks
  "$build/tests/fuzz/fuzz_msh" "$root/tests/data/meshes" "$n" || status=1
  "$build/tests/fuzz/fuzz_scene" "$root/xml" "$n" || status=1
  return $status
}

# make_viewer FILE: bundles apps/report/viewer.js with vtk.js in the versions of package-lock.json, unless FILE is
# up to date. The first call needs npm and its registry. Simultaneous calls wait for each other.
make_viewer() {
  local folder=$build/report source=$root/apps/report input
  input=$(cat "$source"/{package.json,package-lock.json,viewer.js} | sha256sum)
  if is_bundled "$1"; then return 0; fi
  command -v npm >/dev/null || install_missing "${viewer_packages[@]}"
  mkdir -p "$folder" || return
  { flock 9 && { is_bundled "$1" || bundle_viewer "$1" 9>&-; }; } 9<"$folder"
}

is_bundled() { [[ -f $1 && $(cat "$folder/input" 2>/dev/null) == "$input" ]]; }

bundle_viewer() {
  rm -f "$1"
  cp "$source"/{package.json,package-lock.json,viewer.js} "$folder" || return
  say "bundling the 3D view of reports"
  (cd "$folder" && timeout 300 npm ci --ignore-scripts --no-audit --no-fund --fetch-retries=1 &&
    node_modules/.bin/esbuild viewer.js --bundle --minify --target=es2020 --log-level=warning --outfile="$1.part" &&
    find node_modules -maxdepth 3 -iname 'licen[cs]e*' -type f -printf '\n%p\n\n' -exec cat {} \; >viewer.licenses) \
    >"$folder/npm.log" 2>&1 </dev/null || return
  mv "$1.part" "$1" && echo "$input" >"$folder/input"
}

# docs [options]: the web site; with --gallery, its pictures
docs() {
  if [[ " $* " == *" --gallery"* ]]; then
    install_missing "${plot_packages[@]}" "${mesh_packages[@]}"
    build sprekk_app
  else
    install_missing "${docs_packages[@]}"
  fi
  exec "$(debian_python)" -B "$root/apps/docs" "$@"
}

# perf NAME [options]: the measurement perf/NAME/NAME.py; perf pages: the pages of results
perf() {
  local name=${1-} names needs=(gmsh) targets=(sprekk_app)
  if [[ $name == pages ]]; then
    install_missing python3
    exec "$(debian_python)" -B "$root/perf" "$@"
  fi
  names=$(cd "$root/perf" && for name in */; do if [[ -f $name${name%/}.py ]]; then echo "${name%/}"; fi; done | paste -sd ' ')
  [[ $name && " $names " == *" $name "* ]] || usage_error "perf needs the name of a measurement, one of: $names${name:+; got \"$name\"}"
  if [[ $name == networks || $name == contact || $name == upscale || $name == laws || $name == meshing ]]; then needs+=("${mesh_packages[@]}"); fi
  if [[ $name == contact || $name == experiments ]]; then needs+=(python3-scipy); fi
  if [[ $name == verification ]]; then needs+=(python3-sympy); fi
  if [[ $name == bulk ]]; then needs+=(python3-dolfinx); fi
  if [[ $name == build ]]; then  # builds in a separate copy
    install_missing "${packages[@]}"
    exec "$(debian_python)" -B "$root/perf" "$@"
  fi
  if [[ $name == python || $name == upscale ]]; then
    needs+=("${python_packages[@]}") targets+=(sprekk_python)
    export PYTHONPATH=$build/python
  fi
  if [[ $name == peer && ${POREPY-} ]]; then needs+=("${peer_packages[@]}"); fi
  if [[ $name == peer && ${OGS-} ]]; then needs+=(python3-scipy); fi
  if [[ -f $root/perf/$name/CMakeLists.txt ]]; then targets+=("perf_$name"); fi
  install_missing "${plot_packages[@]}" "${needs[@]}"
  build "${targets[@]}"
  exec "$(debian_python)" -B "$root/perf" "$@"
}

# comma_separated NAMES...: sorted, each one once
comma_separated() { printf '%s\n' "$@" | sort -u | paste -sd ,; }

# cached NAME: from CMake's cache
cached() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }

# logged NAME COMMAND...: into the log of that name; ends the launcher if the command fails.
logged() {
  local log=$build/$1.log
  say "making packages: $1"
  "${@:2}" >"$log" 2>&1 </dev/null || { tail -n 20 "$log" >&2; say "this failed; the log is $log"; exit 1; }
}

# package: in output/packages, with checksums. The source archive has the files of the last commit.
make_packages() {
  local folder=$root/output/packages libraries=() name version
  local apps=("${plot_packages[@]}" "${mesh_packages[@]}" "${fit_packages[@]}" "${python_packages[@]}")
  install_missing "${packages[@]}" "${package_packages[@]}"
  build sprekk_app sprekk_python
  make_viewer "$build/report/viewer.js.bundle" || { say "bundling the 3D view failed; see $build/report/npm.log"; exit 1; }
  rm -rf "$folder" "$build/cpack"
  mkdir -p "$folder"
  for name in "${packages[@]}"; do
    if [[ $name == *-dev && $name != @(libgtest|libgmock|pybind11|libpython3)-dev ]]; then libraries+=("$name"); fi
  done
  logged debian cpack --config "$build/CPackConfig.cmake" -B "$build/cpack" \
    -D CPACK_DEBIAN_SPREKK_PACKAGE_RECOMMENDS="$(comma_separated "${apps[@]}")" \
    -D CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS="$(comma_separated "${libraries[@]}")"
  mv "$build"/cpack/*.deb "$folder"
  logged wheel env CC="$(cached CMAKE_C_COMPILER)" CXX="$(cached CMAKE_CXX_COMPILER)" \
    "$(debian_python)" -m pip wheel --no-deps --config-settings=build-dir=build-wheel \
    --wheel-dir "$folder" "$root"
  version=$(cached CMAKE_PROJECT_VERSION)
  if [[ -e $root/.git ]]; then
    [[ ! $(git -C "$root" status --porcelain) ]] || say "the source archive is without the changes since the last commit"
    git -C "$root" archive --prefix="sprekk-$version/" -o "$folder/sprekk-$version.tar.gz" HEAD
  else
    say "no source archive: this tree is not a clone by git"
  fi
  (cd "$folder" && sha256sum -- * >SHA256SUMS)
  (cd "$root" && ls output/packages/*)
}

# source_tree_command NAME [words]
source_tree_command() {
  case $1 in
    build) build all ;;
    docs) docs "${@:2}" ;;
    fuzz) fuzz "${@:2}" ;;
    package) make_packages ;;
    perf) perf "${@:2}" ;;
    test)
      install_missing "${plot_packages[@]}" "${mesh_packages[@]}" "${fit_packages[@]}" "${python_packages[@]}" \
        "${notebook_packages[@]}" "${docs_packages[@]}" "${test_packages[@]}"
      install_browser
      build all
      run_tests "${@:2}" ;;
  esac
}
