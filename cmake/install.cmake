# What `cmake --install` puts where: components runtime, development, documentation and examples.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(CREDENCE_DATA ${CMAKE_INSTALL_DATADIR}/credence)
set(CREDENCE_PACKAGE ${CMAKE_INSTALL_LIBDIR}/cmake/credence)

# The program itself prints the completion and what the manual pages are made of. They are written during installation,
# because the program alone may have been built.
set(pages ${PROJECT_BINARY_DIR}/pages)
install(CODE "file(MAKE_DIRECTORY \"${pages}\")
execute_process(COMMAND \"$<TARGET_FILE:credence>\" completion bash OUTPUT_FILE \"${pages}/credence\"
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:credence> -D VERSION=${PROJECT_VERSION}
  -D FOLDER=${pages}/man -P ${CMAKE_CURRENT_LIST_DIR}/manual.cmake COMMAND_ERROR_IS_FATAL ANY)" COMPONENT runtime)
install(TARGETS credence RUNTIME COMPONENT runtime)
install(DIRECTORY ${pages}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime)
install(FILES ${pages}/credence DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT runtime)

# find_package(credence) gives credence::credence, and credence::program for a program with worlds of one's own.
set_target_properties(credence_library PROPERTIES EXPORT_NAME credence)
set_target_properties(credence_core PROPERTIES EXPORT_NAME core)
set_target_properties(credence_program PROPERTIES EXPORT_NAME program)
install(TARGETS credence_program credence_library credence_core EXPORT credence-targets
  ARCHIVE COMPONENT development INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/credence DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(EXPORT credence-targets NAMESPACE credence:: DESTINATION ${CREDENCE_PACKAGE} COMPONENT development)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/credence-config.cmake.in
  ${PROJECT_BINARY_DIR}/credence-config.cmake INSTALL_DESTINATION ${CREDENCE_PACKAGE})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/credence-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/credence-config.cmake ${PROJECT_BINARY_DIR}/credence-config-version.cmake
  cmake/add_world.cmake cmake/target_object.cmake cmake/FindDeflate.cmake DESTINATION ${CREDENCE_PACKAGE} COMPONENT development)

install(FILES README.md CHANGELOG.md LICENSE CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documentation
  FILES_MATCHING PATTERN "*.md" PATTERN "*.svg" PATTERN "*.png" PATTERN "notebooks/*.py"
  PATTERN "site" EXCLUDE)
install(DIRECTORY experiments DESTINATION ${CREDENCE_DATA} COMPONENT examples
  FILES_MATCHING PATTERN "*.ini" PATTERN "own_filter/*" PATTERN "planner/*" PATTERN "worlds/*")
install(DIRECTORY analysis DESTINATION ${CREDENCE_DATA} COMPONENT examples
  PATTERN "__pycache__" EXCLUDE PATTERN "*.h5" EXCLUDE)
install(DIRECTORY python/credence DESTINATION ${CREDENCE_DATA}/python COMPONENT examples
  FILES_MATCHING PATTERN "*.py" PATTERN "__pycache__" EXCLUDE)
include(cmake/packages.cmake)
