#include "src/colmap/fatal_errors.h"

#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <system_error>

#include "src/colmap/guest.h"
#include "src/colmap/step_bar.h"

namespace tapa {
namespace {

FatalErrors* innermost = nullptr;
std::atomic<bool> has_failed{false};
bool is_graphical = false;

// What a message quotes of a file may have line breaks, and characters that
// command a terminal.
std::string OnOneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](unsigned char code) { return code < 0x20 || code == 0x7f; }, '?');
  return text;
}

// One line of what went wrong.
void Report(const std::string& text) {
  const std::string line = OnOneLine(text);
  std::cout << std::flush;
  if (IsGuest()) {
    TellHost(line);
  } else {
    std::cerr << "ERROR: " << line << std::endl;
  }
}

// Other threads may still run.
[[noreturn]] void ExitNow() {
  if (IsGuest()) {
    EndGuestThread();
  }
  std::cout << std::flush;
  std::cerr << std::flush;
  _exit(EXIT_FAILURE);
}

// As glog wants it: [[noreturn]] is no part of a type.
void __attribute__((noreturn)) EndThread() { EndGuestThread(); }

void PrintException(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const std::bad_alloc&) {
    PrintError("There is not enough memory");
  } catch (const std::system_error& error) {
    // Of threads it says no more than "Resource temporarily unavailable".
    PrintError(error.code() == std::errc::resource_unavailable_try_again
                   ? "No further thread can be started: there is not enough "
                     "memory, or there are too many processes"
                   : error.what());
  } catch (const std::exception& error) {
    PrintError(error.what());
  } catch (...) {
    PrintError("Something unknown went wrong");
  }
}

// Of an exception that a thread did not catch.
[[noreturn]] void Terminate() {
  if (const std::exception_ptr exception = std::current_exception()) {
    PrintException(exception);
    ExitNow();
  }
  std::abort();
}

}  // namespace

FatalErrors::FatalErrors(const std::string& context)
    : context_(context),
      stderr_threshold_(FLAGS_stderrthreshold),
      outer_terminate_(std::set_terminate(&Terminate)),
      outer_(innermost) {
  innermost = this;
  if (IsGuest()) {
    google::InstallFailureFunction(&EndThread);
  }
  google::AddLogSink(this);
  // Otherwise the library would print a line of its own as well.
  FLAGS_stderrthreshold = google::NUM_SEVERITIES;
}

FatalErrors::~FatalErrors() {
  FLAGS_stderrthreshold = stderr_threshold_;
  google::RemoveLogSink(this);
  innermost = outer_;
  std::set_terminate(outer_terminate_);
}

void FatalErrors::send(google::LogSeverity severity, const char*, const char*,
                       int, const struct ::tm*, const char* message,
                       size_t length) {
  if (severity < google::GLOG_ERROR || this != innermost) {
    return;
  }
  std::string text(message, length);
  for (char& c : text) {
    if (c == '\n') {
      c = ' ';
    }
  }
  Report(context_ + ": " + text);
  // A guest's thread must not go to sleep with the library's lock: the library
  // calls EndGuestThread when it has let it go.
  if (severity == google::GLOG_FATAL && !IsGuest()) {
    ExitNow();
  }
}

void PrintError(const std::string& text) {
  Report(text + ".");
  has_failed = true;
}

void EndForDatabase(const char* error) {
  LOG(FATAL) << "The database of features and matches cannot be read or "
                "written: "
             << error
             << "; see to it that there is room, and that no other program "
                "uses it, then run the same command again to go on.";
  std::abort();  // LOG does not return.
}

void CheckDatabaseCommand(int result, const char* error) {
  constexpr int kPrimaryCode = 0xff;
  if (result != SQLITE_OK && (result & kPrimaryCode) != SQLITE_READONLY) {
    EndForDatabase(error != nullptr ? error : sqlite3_errstr(result));
  }
}

bool IsGraphical() { return is_graphical; }

int RunCommand(const std::string& name,
               const std::function<int(int, char**)>& command, int argc,
               char** argv) {
  is_graphical = name == "gui";
  const FatalErrors fatal_errors(name);
  const StepBar step_bar;
  try {
    const int status = command(argc, argv);
    return status == EXIT_SUCCESS && has_failed ? EXIT_FAILURE : status;
  } catch (...) {
    PrintException(std::current_exception());
  }
  // Threads that are left must not come upon what is being destroyed.
  ExitNow();
}

}  // namespace tapa
