# `cpack -G DEB` in a build folder makes the packages credence and libcredence-dev of what install.cmake installs, in its
# folder packages. The first has the program, its pages, the scenarios and scripts; the second what a program with worlds
# of one's own is compiled of.
set(CPACK_PACKAGE_NAME credence)
set(CPACK_PACKAGE_CONTACT "The credence authors <credence@credence.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Monte Carlo consistency studies of filters")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime documentation examples development)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian_files.cmake)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME credence)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION
  "Tells from errors and covariances whether a filter is consistent, optimistic
or pessimistic, and runs studies of seeded trials.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libcredence-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "Headers, static libraries and the CMake package,
for filters and worlds of one's own.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "g++, binutils, libeigen3-dev, libboost-program-options-dev, libhdf5-dev, libdeflate-dev")
include(CPack)
cpack_add_component(runtime GROUP program)
cpack_add_component(documentation GROUP program)
cpack_add_component(examples GROUP program)
cpack_add_component(development GROUP development)
cpack_add_component_group(program)
cpack_add_component_group(development)
