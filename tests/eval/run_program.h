#ifndef TAPA_TESTS_EVAL_RUN_PROGRAM_H_
#define TAPA_TESTS_EVAL_RUN_PROGRAM_H_

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
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

// That a run ended with one line which begins with "ERROR: " and says `part`.
inline void ExpectErrorLine(const Result& result, int exit_code,
                            const std::string& part) {
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  EXPECT_EQ(result.err.find("ERROR: "), 0u) << result.err;
  ExpectContains(result.err, part);
  EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
}

// Tests of a program, which is run in a folder of its own.
class ProgramTest : public ::testing::Test {
 protected:
  explicit ProgramTest(const std::string& program) : program_(program) {}

  // out.txt and err.txt take what the program prints.
  Result Run(const std::string& arguments) {
    const std::string out = folder_.File("out.txt");
    const std::string err = folder_.File("err.txt");
    const std::string command = "cd '" + folder_.path() + "' && '" + program_ +
                                "' " + arguments + " > '" + out + "' 2> '" +
                                err + "'";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, ReadText(out),
            ReadText(err)};
  }

  void ExpectError(const std::string& arguments, const std::string& part,
                   int exit_code = 1) {
    SCOPED_TRACE(arguments);
    ExpectErrorLine(Run(arguments), exit_code, part);
  }

  nlohmann::json ReadJson(const std::string& name) {
    return nlohmann::json::parse(ReadText(folder_.File(name)));
  }

  TemporaryFolder folder_;

 private:
  std::string program_;
};

}  // namespace tapa

#endif  // TAPA_TESTS_EVAL_RUN_PROGRAM_H_
