# Sourced: package_venv FOLDER makes the environment FOLDER/venv with the Python package, from the library in build/, and
# what python/requirements.txt names. The installed library is linked, so that only the bindings are compiled.
package_venv() {
  /usr/bin/python3 -m venv "$1/venv"
  "$1/venv/bin/pip" install -q --no-compile --disable-pip-version-check -r python/requirements.txt
  cmake --install build --prefix "$1/installed" --component development >/dev/null
  PATH=$1/venv/bin:$PATH "$1/venv/bin/pip" wheel -q --disable-pip-version-check . --no-deps --no-build-isolation -w "$1" \
    --config-settings=cmake.define.CREDENCE_PREFIX="$1/installed"
  "$1/venv/bin/pip" install -q --disable-pip-version-check "$1"/*.whl
}
