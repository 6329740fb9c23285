#include "src/colmap/fatal_errors.h"

#include <unistd.h>

#include <cstdlib>
#include <iostream>

namespace tapa {

FatalErrors::FatalErrors(const std::string& context)
    : context_(context), stderr_threshold_(FLAGS_stderrthreshold) {
  google::AddLogSink(this);
  // Otherwise the library would print a line of its own as well.
  FLAGS_stderrthreshold = google::NUM_SEVERITIES;
}

FatalErrors::~FatalErrors() {
  FLAGS_stderrthreshold = stderr_threshold_;
  google::RemoveLogSink(this);
}

void FatalErrors::send(google::LogSeverity severity, const char*, const char*,
                       int, const struct ::tm*, const char* message,
                       size_t length) {
  if (severity < google::GLOG_ERROR) {
    return;
  }
  std::string text(message, length);
  for (char& c : text) {
    if (c == '\n') {
      c = ' ';
    }
  }
  std::cout << std::flush;
  std::cerr << "ERROR: " << context_ << ": " << text << std::endl;
  if (severity == google::GLOG_FATAL) {
    // Not exit(): other threads still run.
    _exit(EXIT_FAILURE);
  }
}

}  // namespace tapa
