#ifndef TAPA_TESTS_EVAL_RUN_PROGRAM_H_
#define TAPA_TESTS_EVAL_RUN_PROGRAM_H_

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/eval/test_files.h"

namespace tapa {

inline std::string ReadText(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

struct Result {
  int exit_code = -1;
  std::string out;
  std::string err;
};

// Runs a program in a folder, where out.txt and err.txt take what it prints.
inline Result RunProgram(const std::string& program,
                         const std::string& arguments,
                         const TemporaryFolder& folder) {
  const std::string out = folder.File("out.txt");
  const std::string err = folder.File("err.txt");
  const std::string command = "cd '" + folder.path() + "' && '" + program +
                              "' " + arguments + " > '" + out + "' 2> '" + err +
                              "'";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, ReadText(out),
          ReadText(err)};
}

// That a run ended with one line which begins with "ERROR: " and says `part`.
inline void ExpectErrorLine(const Result& result, int exit_code,
                            const std::string& part) {
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  EXPECT_EQ(result.err.find("ERROR: "), 0u) << result.err;
  ExpectContains(result.err, part);
  EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
}

}  // namespace tapa

#endif  // TAPA_TESTS_EVAL_RUN_PROGRAM_H_
