# SPDX-License-Identifier: BSD-3-Clause
# Included by ctest with NAME, PROGRAM, FOLDER, LABEL, NIGHTLY and PROPERTIES set: registers each suite of a
# GoogleTest program as NAME.SUITE. A suite runs in one process, so that its cases share what they simulate. The
# cases SUITE.CASE that NIGHTLY lists are registered apart, with the label nightly. The list of suites is kept until
# the program changes.
if(NOT EXISTS "${PROGRAM}")
  add_test(${NAME}_NOT_BUILT "${PROGRAM}")
  set_tests_properties(${NAME}_NOT_BUILT PROPERTIES LABELS ${LABEL} ${PROPERTIES})
  return()
endif()
set(list "${FOLDER}/${NAME}_suites.txt")
if(NOT EXISTS "${list}" OR "${PROGRAM}" IS_NEWER_THAN "${list}")
  execute_process(COMMAND "${PROGRAM}" --gtest_list_tests WORKING_DIRECTORY "${FOLDER}"
    OUTPUT_VARIABLE output RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "${PROGRAM} does not list its tests:\n${output}")
  endif()
  file(WRITE "${list}" "${output}")
endif()
macro(register test label filter)
  add_test(${test} "${PROGRAM}" "--gtest_filter=${filter}")
  set_tests_properties(${test} PROPERTIES WORKING_DIRECTORY "${FOLDER}" LABELS ${label} ${PROPERTIES})
endmacro()
file(STRINGS "${list}" suites REGEX "^[A-Za-z_0-9/]+\\.( +#.*)?$")
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "\\..*$" "" suite "${suite}")
  set(apart ${NIGHTLY})
  list(FILTER apart INCLUDE REGEX "^${suite}\\.")
  list(JOIN apart ":" without)
  register(${NAME}.${suite} ${LABEL} "${suite}.*-${without}")
endforeach()
foreach(case IN LISTS NIGHTLY)
  register(${NAME}.${case} nightly "${case}")
endforeach()
