# credence_add_world(TARGET HEADER...): runs the worlds of these headers in lanes, in the program TARGET. A header ends
# with CREDENCE_WORLD(World) for each of its worlds. The headers are compiled once for each instruction set that the
# engine has, and the program chooses one of these objects when it starts.
#
# Such an object must not share a symbol with the rest of the program: the linker could give an old processor a new
# one's instructions. target_object.cmake makes all of its symbols its own, but for those by which it is found.
set(CREDENCE_TARGET_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/target_object.cmake CACHE INTERNAL "Script of credence_add_world")

# LLVM's tools, which CMake takes with clang, do not join the groups of an object.
function(credence_find_tool tool name)
  set(CREDENCE_${tool} "${CMAKE_${tool}}" PARENT_SCOPE)
  if("${CMAKE_${tool}}" MATCHES "llvm|lld")
    find_program(CREDENCE_GNU_${tool} NAMES ${name})
    mark_as_advanced(CREDENCE_GNU_${tool})
    set(CREDENCE_${tool} "${CREDENCE_GNU_${tool}}" PARENT_SCOPE)
  endif()
endfunction()

function(credence_add_world program)
  credence_find_tool(LINKER ld.bfd)
  credence_find_tool(OBJCOPY objcopy)
  credence_find_tool(NM nm)
  if(NOT CREDENCE_LINKER OR NOT CREDENCE_OBJCOPY OR NOT CREDENCE_NM OR APPLE OR WIN32)
    message(STATUS "credence: the worlds of ${program} run one trial at a time, because binutils are missing")
    return()
  endif()
  set(lanes_portable 1)
  set(lanes_v3 4)
  set(lanes_v4 8)
  set(flags_v3 -march=x86-64-v3)
  set(flags_v4 -march=x86-64-v4 -mprefer-vector-width=512)
  set(includes "")
  foreach(header ${ARGN})
    get_filename_component(header ${header} ABSOLUTE)
    string(APPEND includes "#include \"${header}\"\n")
  endforeach()
  # Settings are handed to the objects, so that matrices in them must be aligned alike.
  target_compile_definitions(${program} PRIVATE EIGEN_MAX_STATIC_ALIGN_BYTES=16 CREDENCE_HAS_TARGET_OBJECTS)
  foreach(name ${CREDENCE_TARGETS})
    set(own ${program}_${name})
    file(CONFIGURE OUTPUT ${own}.cpp CONTENT "${includes}" @ONLY)
    add_library(${own} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${own}.cpp)
    set_target_properties(${own} PROPERTIES UNITY_BUILD OFF INTERPROCEDURAL_OPTIMIZATION OFF EXCLUDE_FROM_ALL ON)
    target_link_libraries(${own} PRIVATE $<TARGET_PROPERTY:${program},LINK_LIBRARIES>)
    target_include_directories(${own} PRIVATE $<TARGET_PROPERTY:${program},INCLUDE_DIRECTORIES>)
    # Without vectors of its own, Eigen adds doubles in one order everywhere; packs on the heap need their alignment.
    target_compile_definitions(${own} PRIVATE $<TARGET_PROPERTY:${program},COMPILE_DEFINITIONS> CREDENCE_TARGET_OBJECT
      CREDENCE_TARGET=${name} CREDENCE_LANES=${lanes_${name}}
      EIGEN_DONT_VECTORIZE EIGEN_DONT_PARALLELIZE EIGEN_MAX_ALIGN_BYTES=64)
    # (objcopy cannot make g++'s unique symbols local.)
    target_compile_options(${own} PRIVATE $<TARGET_PROPERTY:${program},COMPILE_OPTIONS> ${flags_${name}} -fno-lto
      -ffp-contract=off -fno-math-errno
      $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize> $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
    set(object ${CMAKE_CURRENT_BINARY_DIR}/${own}.o)
    add_custom_command(OUTPUT ${object}
      COMMAND ${CMAKE_COMMAND} -D COMPILED=$<TARGET_OBJECTS:${own}> -D TARGET=${name} -D OBJECT=${object}
        -D LINKER=${CREDENCE_LINKER} -D OBJCOPY=${CREDENCE_OBJCOPY} -D NM=${CREDENCE_NM} -P ${CREDENCE_TARGET_SCRIPT}
      DEPENDS ${own} $<TARGET_OBJECTS:${own}> ${CREDENCE_TARGET_SCRIPT} VERBATIM)
    set_source_files_properties(${object} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
    target_sources(${program} PRIVATE ${object})
  endforeach()
endfunction()
