#ifndef TAPA_SRC_EVAL_COMMAND_LINE_H_
#define TAPA_SRC_EVAL_COMMAND_LINE_H_

#include <boost/program_options.hpp>
#include <functional>
#include <stdexcept>
#include <string>

namespace tapa {

// Named options of a program, in full, as in COLMAP.
class CommandLine {
 public:
  // `about` is what --help says above the options.
  explicit CommandLine(const std::string& about);

  // An option that is stored in `value`, whose default is shown if it has one.
  template <typename T>
  void Add(const char* name, T* value, const char* text) {
    options_.add_options()(name, boost::program_options::value(value), text);
  }
  template <typename T>
  void AddWithDefault(const char* name, T* value, const char* text) {
    options_.add_options()(
        name, boost::program_options::value(value)->default_value(*value),
        text);
  }

  // Stores the values. Returns false, with all options printed, if --help is
  // given. Throws boost::program_options::error if it does not understand them.
  bool Parse(int argc, char** argv);

  bool IsGiven(const std::string& name) const;
  // Throws std::invalid_argument if the option is not given.
  void Require(const std::string& name) const;

 private:
  boost::program_options::options_description options_;
  boost::program_options::variables_map variables_;
};

// An error with an exit code of its own.
class ExitError : public std::runtime_error {
 public:
  ExitError(int code, const std::string& what)
      : std::runtime_error(what), code_(code) {}
  int code() const { return code_; }

 private:
  int code_;
};

// Runs a program. Returns its exit code: 0, or after an exception, of which one
// line on the error stream tells, that of an ExitError or 1.
int RunMain(const std::function<void()>& run);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_COMMAND_LINE_H_
