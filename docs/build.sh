#!/usr/bin/env bash
# Makes the site of these pages, build/site/html: it loads nothing from elsewhere, and can be read from a disk (its search
# needs a server: python3 -m http.server -d build/site/html). Fails at a dead link, at a page that its navigation lacks,
# and at one that code hosts show otherwise. Needs python3-venv.
#
# The notebooks are executed by build/site/venv, which is made once. credence in it is CREDENCE_WHEEL if that is set (a
# wheel, or a name that pip knows), else linked to the library of build/ if there is one, else compiled, which takes some
# minutes. Remove build/site to have a newer credence.
set -euo pipefail
cd "$(dirname "$0")/.."
source experiments/setup.sh
site=build/site python=build/site/venv/bin/python
pip=("$python" -m pip --disable-pip-version-check install -c python/requirements.txt)

# What only the site needs, and of the rest what the package and its notebooks need.
install_tools() {
  /usr/bin/python3 -m venv $site/venv &&
    "${pip[@]}" $(sed -n 's/ ; extra == "site"$//p' python/requirements.txt) \
      jupytext nbclient ipykernel h5py scipy xarray matplotlib ruff nanobind nanobind-backend scikit-build-core ninja
}

install_credence() {
  if [ -n "${CREDENCE_WHEEL:-}" ]; then
    "${pip[@]}" "$CREDENCE_WHEEL" && touch $site/venv/complete
    return
  fi
  local options=(cmake.define.CMAKE_CXX_FLAGS_RELEASE=-O0 cmake.define.CREDENCE_TARGET_V4=OFF
    cmake.define.CREDENCE_WRITTEN_OUT=0)
  if [ -f build/src/libcredence_program.a ]; then
    cmake --install build --prefix $site/installed --component development || return 1
    options=(cmake.define.CREDENCE_PREFIX="$PWD/$site/installed")
  fi
  PATH=$PWD/$site/venv/bin:$PATH "${pip[@]}" -v --no-build-isolation --no-deps "${options[@]/#/--config-settings=}" . &&
    touch $site/venv/complete
}

mkdir -p $site
if [ ! $site/venv/complete -nt python/requirements.txt ]; then
  install_missing python3-dev python3-venv
  [ -n "${CREDENCE_WHEEL:-}" ] || install_missing $build_packages
  echo "installing MkDocs and credence in $site/venv"
  with_progress $site/tools.log install_tools
  with_progress $site/credence.log install_credence
fi
echo "executing the notebooks"
rm -rf $site/notebooks
$python docs/site/notebooks.py $site/notebooks
NO_MKDOCS_2_WARNING=1 $python -m mkdocs build -f docs/mkdocs.yml
