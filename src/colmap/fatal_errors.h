#ifndef TAPA_SRC_COLMAP_FATAL_ERRORS_H_
#define TAPA_SRC_COLMAP_FATAL_ERRORS_H_

#include <glog/logging.h>

#include <ctime>
#include <exception>
#include <functional>
#include <string>

// This header is included by COLMAP's own sources.

namespace tapa {

// While one of these lives, what COLMAP checks with CHECK and LOG(FATAL) ends
// the program with one line "ERROR: CONTEXT: ..." and exit status 1, in place
// of a stack trace and an abort, and so does an exception that a thread does
// not catch. The innermost one's context counts. Of a guest (guest.h) it ends
// the thread.
class FatalErrors : public google::LogSink {
 public:
  explicit FatalErrors(const std::string& context);
  ~FatalErrors() override;

  FatalErrors(const FatalErrors&) = delete;
  FatalErrors& operator=(const FatalErrors&) = delete;

  using google::LogSink::send;
  void send(google::LogSeverity severity, const char* full_filename,
            const char* base_filename, int line, const struct ::tm* time,
            const char* message, size_t length) override;

 private:
  const std::string context_;
  const int stderr_threshold_;
  const std::terminate_handler outer_terminate_;
  FatalErrors* const outer_;
};

// Prints a line "ERROR: TEXT." for what ends a part of the work but not the
// program, whose exit status will be 1.
void PrintError(const std::string& text);

// Ends the program for an error of the database of features and matches.
[[noreturn]] void EndForDatabase(const char* error);

// The same if a command to the database has failed, but not where it may only
// be read: COLMAP brings each one that it opens up to date, and reads on if it
// cannot. result: SQLite's code; error: its text or nullptr.
void CheckDatabaseCommand(int result, const char* error);

// Whether the program shows its graphical interface. An exception must not
// leave what that calls.
bool IsGraphical();

// Runs a command of the program such that it never aborts: a failed check, and
// an exception in any thread, become a line and exit status 1. On a terminal, a
// bar shows how far it is (step_bar.h).
int RunCommand(const std::string& name,
               const std::function<int(int, char**)>& command, int argc,
               char** argv);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_FATAL_ERRORS_H_
