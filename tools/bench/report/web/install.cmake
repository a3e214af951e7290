# npm ci in FOLDER from LISTS; what is wrong is said in one sentence.
file(MAKE_DIRECTORY "${FOLDER}")
file(COPY ${LISTS} DESTINATION "${FOLDER}")
execute_process(
  COMMAND "${NPM}" ci --ignore-scripts --prefer-offline ${DEVELOPMENT}
  WORKING_DIRECTORY "${FOLDER}" RESULT_VARIABLE status OUTPUT_FILE "${FOLDER}/npm.log" ERROR_FILE "${FOLDER}/npm.log")
if(NOT status EQUAL 0)
  message(FATAL_ERROR "The report's libraries could not be fetched from npm's registry (npm ci; ${FOLDER}/npm.log says why). "
                      "To build without interactive diagrams: cmake -DVOBENCH_REPORT_SCRIPTS=OFF.")
endif()
file(TOUCH "${FOLDER}/installed")
