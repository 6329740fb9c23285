#include "src/eval/command_line.h"

#include <iostream>
#include <new>
#include <stdexcept>

namespace tapa {

namespace po = boost::program_options;

CommandLine::CommandLine(const std::string& about)
    : options_(about + "\n\nOptions") {
  options_.add_options()("help", "Print this text.");
}

bool CommandLine::Parse(int argc, char** argv) {
  const int style = po::command_line_style::allow_long |
                    po::command_line_style::long_allow_adjacent |
                    po::command_line_style::long_allow_next;
  po::store(po::command_line_parser(argc, argv)
                .options(options_)
                .positional(po::positional_options_description())
                .style(style)
                .run(),
            variables_);
  if (IsGiven("help")) {
    std::cout << options_;
    return false;
  }
  po::notify(variables_);
  return true;
}

bool CommandLine::IsGiven(const std::string& name) const {
  return variables_.count(name) > 0;
}

void CommandLine::Require(const std::string& name) const {
  if (!IsGiven(name)) {
    throw std::invalid_argument("--" + name + " is required");
  }
}

int RunMain(const std::function<void()>& run) {
  try {
    run();
    return 0;
  } catch (const ExitError& error) {
    std::cerr << "ERROR: " << error.what() << std::endl;
    return error.code();
  } catch (const std::bad_alloc&) {
    std::cerr << "ERROR: there is not enough memory: score less, or use a "
                 "larger machine (docs/evaluation.md says how much)"
              << std::endl;
  } catch (const std::exception& error) {
    std::cerr << "ERROR: " << error.what() << std::endl;
  }
  return 1;
}

}  // namespace tapa
