# Rooms 1 to 9: scenario, draws, world, sensor, filter, controller, trial, block. Nothing but the standard library.

# The engine's unit: one source, one object library for each instruction set, each in a namespace of its own.
function(credence_unit name)
  add_library(credence_unit_${name} OBJECT src/simulate_unit.cpp)
  target_include_directories(credence_unit_${name} PRIVATE include)
  target_compile_definitions(credence_unit_${name} PRIVATE CREDENCE_UNIT=${name})
  target_compile_options(credence_unit_${name} PRIVATE ${ARGN})
  target_link_libraries(credence_unit_${name} PRIVATE credence_flags)
endfunction()

add_library(credence_core STATIC
  src/text.cpp src/scenario.cpp src/scenario_keys.cpp src/scenario_values.cpp
  src/problem.cpp src/record.cpp src/recorded_noise.cpp src/block.cpp src/dispatch.cpp)
target_include_directories(credence_core PUBLIC include)
target_link_libraries(credence_core PUBLIC credence_flags)

credence_unit(portable)
target_sources(credence_core PRIVATE $<TARGET_OBJECTS:credence_unit_portable>)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  credence_unit(v3 -march=x86-64-v3)
  target_sources(credence_core PRIVATE $<TARGET_OBJECTS:credence_unit_v3>)
  target_compile_definitions(credence_core PRIVATE CREDENCE_HAS_V3)
endif()
