# SPDX-License-Identifier: BSD-3-Clause

# Flags that every target of the project shares. Floating-point contraction is off, so that the
# same source gives the same bytes whichever instructions the compiler picks.
add_library(aims_flags INTERFACE)
target_compile_options(aims_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -ffp-contract=off)
target_include_directories(aims_flags INTERFACE ${PROJECT_SOURCE_DIR})
option(AIMS_WERROR "Treat warnings as errors" OFF)
if(AIMS_WERROR)
  target_compile_options(aims_flags INTERFACE -Werror)
endif()
option(AIMS_FUZZ "Build the fuzzers, and all else, for libFuzzer with sanitizers (clang alone)" OFF)
if(AIMS_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "AIMS_FUZZ needs -DCMAKE_CXX_COMPILER=clang++")
  endif()
  set(fuzz_flags -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined)
  target_compile_options(aims_flags INTERFACE ${fuzz_flags})
  target_link_options(aims_flags INTERFACE ${fuzz_flags})
endif()

# A batch compiles several source files as one, so that what they all include is read once: a whole
# build takes less than half the time, a change of one file compiles its batch. Off by default for
# the libraries, where that file alone is faster; scripts/demo.sh and scripts/test.sh switch it on in
# a build folder that they make.
option(AIMS_UNITY "Compile the source files of a library in batches" OFF)

# aims_names_of(PATH DEFINED IMPORTED [FUNCTIONS]): the constants and types (FUNCTIONS: also the functions, which in a
# library are mostly overloads) that a source file defines, and the names that its using-declarations import.
function(aims_names_of path defined imported)
  set(definition "\n(const[a-z]* [^\n=({]* k|struct |class |enum class |using )[A-Z][A-Za-z0-9]*( =)?")
  if("FUNCTIONS" IN_LIST ARGN)
    set(definition "${definition}|\n[A-Za-z][^\n=(]* [a-z_0-9]+\\(")
  endif()
  file(READ ${path} text)
  string(REGEX MATCHALL "${definition}" names "${text}")
  list(FILTER names EXCLUDE REGEX "\nusing .*[^=]$")
  list(TRANSFORM names REPLACE "( =|\\()$" "")
  list(TRANSFORM names REPLACE "^.*[ *&]" "")
  string(REGEX MATCHALL "\nusing [A-Za-z_0-9:]*::[A-Za-z_0-9]*" imports "${text}")
  list(TRANSFORM imports REPLACE "^.*:" "")
  set(${defined} "${names}" PARENT_SCOPE)
  set(${imported} "${imports}" PARENT_SCOPE)
endfunction()

# aims_meet(A B MEET): whether two lists of names have one in common.
function(aims_meet a b meet)
  set(rest ${${a}})
  list(REMOVE_ITEM rest ${${b}} "")
  set(whole ${${a}})
  list(REMOVE_ITEM whole "")
  list(LENGTH rest left)
  list(LENGTH whole all)
  set(${meet} OFF PARENT_SCOPE)
  if(left LESS all)
    set(${meet} ON PARENT_SCOPE)
  endif()
endfunction()

# aims_batches(TARGET [FUNCTIONS]): compiles the target in batches of at most 8 files. Files of a batch share their
# anonymous namespace: each file joins the first batch that has room and none of its names (aims_names_of).
function(aims_batches target)
  get_target_property(sources ${target} SOURCES)
  set(end 0)
  foreach(source ${sources})
    get_filename_component(path ${source} ABSOLUTE)
    if(NOT EXISTS ${path} OR path MATCHES "^${PROJECT_BINARY_DIR}/" OR NOT path MATCHES "\\.cpp$")
      continue()  # generated, or no source file
    endif()
    aims_names_of(${path} names imports ${ARGN})
    set(batch 0)
    while(batch LESS end)
      set(taken ${defined_${batch}} ${imported_${batch}})
      aims_meet(names taken clash)
      aims_meet(imports defined_${batch} hidden)  # an import may be repeated
      if(NOT clash AND NOT hidden AND size_${batch} LESS 8)
        break()
      endif()
      math(EXPR batch "${batch} + 1")
    endwhile()
    if(batch EQUAL end)
      math(EXPR end "${end} + 1")
      set(size_${batch} 0)
    endif()
    math(EXPR size_${batch} "${size_${batch}} + 1")
    list(APPEND defined_${batch} ${names})
    list(APPEND imported_${batch} ${imports})
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${batch})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # GCC takes an anonymous namespace of a file that another includes for one of a header.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

# aims_cold(TARGET): for code that runs once per command and includes much. Always in batches, as
# eight files together compile in the time of one, and without costly optimisations.
function(aims_cold target)
  aims_batches(${target})
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# aims_library(NAME SOURCES file... [LINKS public_target...] [PRIVATE_LINKS target...])
# A static library of the folder NAME with the alias aims::NAME.
function(aims_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(aims_${name} STATIC ${arg_SOURCES})
  add_library(aims::${name} ALIAS aims_${name})
  target_link_libraries(aims_${name} PUBLIC $<BUILD_INTERFACE:aims_flags> ${arg_LINKS}
    PRIVATE ${arg_PRIVATE_LINKS})
  if(AIMS_UNITY)
    aims_batches(aims_${name})
  endif()
endfunction()

# aims_test(NAME SOURCES file... [LINKS target...] [LABEL unit|scenario|nightly|stress] [COST seconds]
#   [NIGHTLY suite.case...])
# A GoogleTest executable whose suites are registered with ctest under one label, but for the cases that are
# NIGHTLY. Its own sources compile without costly optimisations; the libraries that it tests are those of the
# program. ctest starts the tests of the largest cost first, so that no core waits for a long one at the end.
function(aims_test name)
  cmake_parse_arguments(arg "" "LABEL;COST" "SOURCES;LINKS;NIGHTLY" ${ARGN})
  if(NOT arg_LABEL)
    set(arg_LABEL unit)
  endif()
  if(NOT arg_COST)
    set(arg_COST 0)
  endif()
  add_executable(test_${name} ${arg_SOURCES})
  target_link_libraries(test_${name} PRIVATE aims_flags ${arg_LINKS} GTest::gtest_main)
  target_compile_options(test_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(AIMS_UNITY)
    aims_batches(test_${name} FUNCTIONS)
  endif()
  set(suites ${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake)
  file(GENERATE OUTPUT ${suites} CONTENT "set(NAME ${name})
set(PROGRAM \"$<TARGET_FILE:test_${name}>\")
set(FOLDER \"${CMAKE_CURRENT_BINARY_DIR}\")
set(LABEL ${arg_LABEL})
set(NIGHTLY \"${arg_NIGHTLY}\")
set(PROPERTIES TIMEOUT 600 COST ${arg_COST})
include(\"${PROJECT_SOURCE_DIR}/cmake/discover_suites.cmake\")
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${suites})
endfunction()

# aims_bench(NAME SOURCES file... [LINKS target...])
# A Google Benchmark executable; ctest runs it once, short, so that it cannot rot.
function(aims_bench name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(bench_${name} ${arg_SOURCES})
  target_link_libraries(bench_${name} PRIVATE aims_flags ${arg_LINKS} benchmark::benchmark_main)
  add_test(NAME bench_${name} COMMAND bench_${name} --benchmark_min_time=0.01)
  set_tests_properties(bench_${name} PROPERTIES LABELS bench TIMEOUT 300)
endfunction()

# aims_install_with(TARGET COMPONENT DESTINATION FILES file... [RENAME name]): installs the files below
# the prefix if the target was built, which is seen at installation.
function(aims_install_with target component destination)
  cmake_parse_arguments(arg "" "RENAME" "FILES" ${ARGN})
  list(TRANSFORM arg_FILES PREPEND "\"" )
  list(TRANSFORM arg_FILES APPEND "\"")
  list(JOIN arg_FILES " " files)
  if(arg_RENAME)
    set(rename "RENAME \"${arg_RENAME}\"")
  endif()
  install(CODE "if(EXISTS \"$<TARGET_FILE:${target}>\")
  file(INSTALL DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${destination}\" TYPE FILE ${rename} FILES ${files})
endif()" COMPONENT ${component})
endfunction()

# aims_say_left_out(TARGET COMPONENT WHAT): says at installation that the target was not built.
function(aims_say_left_out target component what)
  install(CODE "if(NOT EXISTS \"$<TARGET_FILE:${target}>\")
  message(STATUS \"Left out, since it was not built: ${what}. To build it: cmake --build ${PROJECT_BINARY_DIR} --target ${target}\")
endif()" COMPONENT ${component})
endfunction()
