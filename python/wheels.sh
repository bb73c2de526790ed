#!/usr/bin/env bash
# python/wheels.sh: builds the source distribution, and one wheel for every Python from 3.10 on, in build-wheels/dist. For
# Debian 12, as root or with sudo; the wheel needs a Linux whose glibc is as new as that of Debian 12's libraries ask for
# (auditwheel says: 2.34). It has all targets of the engine, and needs no library of the distribution: HDF5 is compiled
# from Debian's source package without drivers for networks and without szip, which would bring some forty libraries.
# At its end it tries the wheel.
set -euo pipefail
cd "$(dirname "$0")/.."
source experiments/setup.sh
install_missing $build_packages dpkg-dev ninja-build zlib1g-dev python3-dev python3-venv
work=$PWD/build-wheels
mkdir -p "$work"/{dist,sources,hdf5}

/usr/bin/python3 -m venv "$work/venv"
export PATH=$work/venv/bin:$PATH
python -m pip install -q --disable-pip-version-check \
  $(sed -n -E 's/ ; extra == "wheels"$//p; /^(nanobind|nanobind-backend|scikit-build-core|ninja)==/p' python/requirements.txt)

# The source package comes from the distribution that this machine is set up with.
if ! ls "$work"/sources/hdf5-*/ >/dev/null 2>&1; then
  mkdir -p "$work/apt"/{parts,lists/partial}
  for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.{list,sources}; do
    [ ! -s "$list" ] || sed -E 's/^Types:.*/Types: deb-src/; s/^deb /deb-src /' "$list" >"$work/apt/parts/from-${list##*/}"
  done
  mv "$work/apt/parts/from-sources.list" "$work/apt/parts/distribution.list" 2>/dev/null || true
  apt=(-qq -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$work/apt/parts" -o
    Dir::State::lists="$work/apt/lists" -o APT::Sandbox::User=root)
  apt-get "${apt[@]}" update
  (cd "$work/sources" && apt-get "${apt[@]}" source hdf5 >/dev/null)
fi
# HDF5 reads a file that one of its tests writes from the folder in which CMake runs.
prefix=$work/prefix
if [ ! -e "$prefix/lib/libhdf5.a" ]; then
  (cd "$work/hdf5"
    cmake -G Ninja "$(echo "$work"/sources/hdf5-*/)" -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$prefix" \
      -DCMAKE_C_FLAGS=-w -DBUILD_SHARED_LIBS=OFF -DBUILD_TESTING=OFF -DCMAKE_POSITION_INDEPENDENT_CODE=ON \
      -DHDF5_BUILD_{TOOLS,EXAMPLES,CPP_LIB,FORTRAN,JAVA}=OFF -DHDF5_BUILD_HL_LIB=ON -DHDF5_ENABLE_SZIP_SUPPORT=OFF \
      -DHDF5_ENABLE_Z_LIB_SUPPORT=ON >configured
    ninja install >built)
fi

# The licences of what the wheel contains.
licences=$work/LICENCES-OF-LIBRARIES
for library in "$work"/sources/hdf5-*/debian \
    /usr/share/doc/{zlib1g-dev,libdeflate-dev,libboost-dev,libeigen3-dev,nlohmann-json3-dev,libgomp1}; do
  printf '\n== %s ==\n' "$(sed -E 's|/debian$||; s|.*/||' <<<"$library")"
  cat "$library/copyright"
done >"$licences"

# scikit-build-core hands CMAKE_ARGS on to CMake.
export CMAKE_ARGS="-DHDF5_ROOT=$prefix -DHDF5_USE_STATIC_LIBRARIES=ON -DCREDENCE_LICENCES=$licences"
rm -rf "$work/built"
python -m pip wheel --disable-pip-version-check . --no-deps --no-build-isolation -w "$work/built" \
  --config-settings=build-dir="$work/build" >"$work/build.log" 2>&1 || { tail -n 40 "$work/build.log"; exit 1; }
rm -f "$work"/dist/*
auditwheel repair -w "$work/dist" "$work"/built/*.whl
wheel=$(ls "$work"/dist/*.whl)
if [ "$(stat -c %s "$wheel")" -gt 15000000 ]; then echo "$wheel is larger than 15 MB"; exit 1; fi
python -c 'import sys; from scikit_build_core.build import build_sdist; build_sdist(sys.argv[1])' "$work/dist"

# It works in an environment of its own, and all of its targets say the same, as does the program of a build here.
try=$(mktemp -d)
trap 'rm -rf "$try"' EXIT
/usr/bin/python3 -m venv "$try/venv"
"$try/venv/bin/python" -m pip install -q --disable-pip-version-check "$wheel"
said() { "$@" run experiments/seed/ekf-circle-ranged.ini --trials 512 --quiet --overwrite -o "$try/study.h5" &&
  "$@" report "$try/study.h5" --format json; }
said "$try/venv/bin/python" -m credence >"$try/here"
for target in portable v3; do
  CREDENCE_FORCE_TARGET=$target said "$try/venv/bin/python" -m credence | cmp - "$try/here"
done
if [ -x build/credence ]; then said build/credence | cmp - "$try/here"; fi
ls -l "$work/dist"
