# MPI where it can be used. FindMPI ends the configuration, in spite of QUIET, where the wrapper of the compiler names
# folders that do not exist: Open MPI's programs come without its headers when another package, such as Octave, asks for
# them.
set(CREDENCE_MPI AUTO CACHE STRING "Build with MPI: AUTO (where it is found), ON (it must be found), OFF")
set_property(CACHE CREDENCE_MPI PROPERTY STRINGS AUTO ON OFF)
if(NOT CREDENCE_MPI MATCHES "^(AUTO|ON|OFF)$")
  message(FATAL_ERROR "invalid CREDENCE_MPI=${CREDENCE_MPI} (not one of its choices). Give AUTO, ON or OFF.")
endif()

# credence_probe_mpi(WHY): what is wrong with MPI, empty where nothing is. A separate project looks for MPI, with this
# project's settings; a success is remembered.
function(credence_probe_mpi why)
  set(${why} "" PARENT_SCOPE)
  if(CREDENCE_MPI_USABLE)
    return()
  endif()
  get_cmake_property(variables CACHE_VARIABLES)
  list(FILTER variables INCLUDE REGEX "^(MPI|CMAKE_C_COMPILER$|CMAKE_PREFIX_PATH$|CMAKE_TOOLCHAIN_FILE$)")
  set(given "")
  foreach(variable ${variables})
    string(REPLACE ";" "\\;" value "${${variable}}")
    list(APPEND given "-D${variable}=${value}")
  endforeach()
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/mpi_probe)
  file(REMOVE_RECURSE ${folder})
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/mpi_probe -B ${folder} ${given}
    RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE said)
  if(NOT failed)
    set(CREDENCE_MPI_USABLE ON CACHE INTERNAL "MPI compiles a program")
  elseif(said MATCHES "includes non-existent path[ \n]+\"([^\"]*)\"")
    set(${why} "its compiler includes ${CMAKE_MATCH_1}, which does not exist" PARENT_SCOPE)
  else()
    set(${why} "none was found that compiles a program" PARENT_SCOPE)
  endif()
endfunction()

# credence_find_mpi(): finds MPI::MPI_C, as CREDENCE_MPI says.
macro(credence_find_mpi)
  credence_probe_mpi(credence_mpi_why)
  if(NOT credence_mpi_why)
    if(CREDENCE_MPI STREQUAL ON)
      find_package(MPI REQUIRED COMPONENTS C)
    else()
      find_package(MPI QUIET COMPONENTS C)
    endif()
  elseif(CREDENCE_MPI STREQUAL ON)
    message(FATAL_ERROR "invalid CREDENCE_MPI=ON (MPI cannot be used: ${credence_mpi_why}). Install its headers (Debian: "
      "libopenmpi-dev), name another compiler with MPI_C_COMPILER, or give CREDENCE_MPI=OFF.")
  else()
    message(STATUS "MPI: ${credence_mpi_why}; credence is built without it")
  endif()
endmacro()
