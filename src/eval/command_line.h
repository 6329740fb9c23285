#ifndef TAPA_SRC_EVAL_COMMAND_LINE_H_
#define TAPA_SRC_EVAL_COMMAND_LINE_H_

#include <boost/program_options.hpp>
#include <optional>

namespace tapa {

// Reads a command line that has named options only, with their names in full,
// as in COLMAP, and stores their values where the options say. Prints the
// options and returns nothing if --help, which has to be among them, is given.
// Throws boost::program_options::error if the command line is not understood.
std::optional<boost::program_options::variables_map> ParseCommandLine(
    int argc, char** argv,
    const boost::program_options::options_description& options);

}  // namespace tapa

#endif  // TAPA_SRC_EVAL_COMMAND_LINE_H_
