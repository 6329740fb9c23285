#include "src/eval/command_line.h"

#include <iostream>

namespace tapa {

namespace po = boost::program_options;

std::optional<po::variables_map> ParseCommandLine(
    int argc, char** argv, const po::options_description& options) {
  const int style = po::command_line_style::allow_long |
                    po::command_line_style::long_allow_adjacent |
                    po::command_line_style::long_allow_next;
  po::variables_map variables;
  po::store(po::command_line_parser(argc, argv)
                .options(options)
                .positional(po::positional_options_description())
                .style(style)
                .run(),
            variables);
  if (variables.count("help") > 0) {
    std::cout << options;
    return std::nullopt;
  }
  po::notify(variables);
  return variables;
}

}  // namespace tapa
