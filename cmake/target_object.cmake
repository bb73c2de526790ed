# Makes OBJECT of the object file COMPILED for TARGET: of its symbols, only lanes_of<World>, by which a program finds it,
# stays one that others see. What it would initialise when the program starts goes to a section of its own, which
# lanes_of runs: a processor without the instructions must not come there.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed ERROR_VARIABLE said OUTPUT_VARIABLE output)
  if(failed)
    message(FATAL_ERROR "${ARGN}: ${said}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

string(LENGTH ${TARGET} length)
run(${LINKER} -r --force-group-allocation ${COMPILED} -o ${OBJECT}.whole)
run(${OBJCOPY} --wildcard --keep-global-symbol=_ZN8credence${length}${TARGET}8lanes_of*
  --rename-section .init_array=credence_init_${TARGET} ${OBJECT}.whole ${OBJECT})
file(REMOVE ${OBJECT}.whole)
run(${NM} --defined-only --extern-only ${OBJECT})
if(NOT output MATCHES "8lanes_of")
  file(REMOVE ${OBJECT})
  message(FATAL_ERROR "credence_add_world: no header names its world. End it with CREDENCE_WORLD(World);")
endif()
