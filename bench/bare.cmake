# The engine without its statistics beyond NEES, NIS and trace(P), so that their cost can be measured against it in one
# run: a copy of the sources in which the lines below are taken out. Configuring stops where one of them is not found.
set(bare_folder ${CMAKE_CURRENT_BINARY_DIR}/bare)
file(COPY ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src DESTINATION ${bare_folder})

# without(FILE TEXT [TEXT INSTEAD]...): copies a file of the project with texts replaced.
function(without file)
  file(READ ${PROJECT_SOURCE_DIR}/${file} source)
  set(pairs ${ARGN})
  while(pairs)
    list(POP_FRONT pairs text instead)
    string(FIND "${source}" "${text}" found)
    if(found EQUAL -1)
      message(FATAL_ERROR "bench/bare.cmake: ${file} does not hold: ${text}")
    endif()
    string(REPLACE "${text}" "${instead}" source "${source}")
  endwhile()
  file(WRITE ${bare_folder}/${file} "${source}")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${file})
endfunction()

# Texts without semicolons, which CMake's lists take for their own.
without(src/slam/trial/step_evaluation.hpp
  "        standardise(i)" "        (void)standardise"
  "(n - i) % 2 == 0) standardise(i + one)" "(n - i) % 2 == 0) (void)0"
  "evaluation.standardised_error[0] * evaluation.standardised_error[0]" "error[0] * error[0] / P.entry[0][0]"
  "    write(update.nis_features)" "    (void)0"
  "    write(update.nis_edges)" "    (void)0"
  "    write(update.unseen)" "    write(trace_P)"
  "    add_by_group<Real>(layout, [&](auto i) { return error[i] * error[i]" "    (void)([&](auto i) { return error[i] * error[i]"
  "    add_by_group<Real>(layout, [&](auto i) { return Real(reported) * belief.covariance.entry[i][i]" "    (void)([&](auto i) { return Real(reported) * belief.covariance.entry[i][i]"
  "    each(zero, n, [&](auto i) { write(evaluation.standardised_error[i] * inverse_root)" "    each(zero, n, [&](auto) { (void)inverse_root")
without(src/slam/update.hpp
  "return nis_of_edges(belief.covariance, filter, layout, contrasts, work)" "return (void)work, Real(0)"
  "    update.nis_features = update.nis" "    (void)0")
# The series that remain: NEES by group, NIS, its rows, trace(P).
without(src/engine/simulate_batch.hpp
  "problem.series_count" "(problem.group_count + 3)"
  "        fold_coverage(unfolded, b, steps, problem.coverage_bounds + b * coverage_level_count, batch)" "            (void)b")

credence_target(bare 8 3 credence_bench -march=x86-64-v4 -mprefer-vector-width=512)
set_target_properties(credence_target_bare PROPERTIES INCLUDE_DIRECTORIES "${bare_folder}/include;${bare_folder}/src")
target_compile_options(credence_target_bare PRIVATE -Wno-unused-but-set-variable)
