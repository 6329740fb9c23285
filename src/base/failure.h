#ifndef TAPA_SRC_BASE_FAILURE_H_
#define TAPA_SRC_BASE_FAILURE_H_

#include <stdexcept>

namespace tapa {

// Ends a run with one line for the user: what is wrong, and what to do.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The same for a file that the system does not let be read. There need be
// nothing wrong with what it has.
class ReadFailure : public Failure {
 public:
  using Failure::Failure;
};

}  // namespace tapa

#endif  // TAPA_SRC_BASE_FAILURE_H_
