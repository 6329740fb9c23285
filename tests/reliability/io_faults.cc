// Preloaded into a program, makes one of its file operations fail, or kills the
// program before it. It counts operations on what is below one folder only, so
// that the program's libraries and the system's files do not matter.
//
//   TAPA_IO_FOLDER   the folder, without symbolic links
//   TAPA_IO_KIND     "change" (opening for writing, writing, renaming, ...) or
//                    "read" (opening for reading, reading)
//   TAPA_IO_AT       the number of the operation, from 1 on; 0: none
//   TAPA_IO_ONWARD   1: all from there on
//   TAPA_IO_ERROR    the number of the error; -1: kill the program
//   TAPA_IO_COUNT    where the number of operations is written at the end

#include <dlfcn.h>
#include <fcntl.h>
#include <stdio_ext.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

std::string Setting(const char* name) {
  const char* value = getenv(name);
  return value == nullptr ? "" : value;
}

struct Settings {
  const std::string folder = Setting("TAPA_IO_FOLDER") + "/";
  const bool of_reads = Setting("TAPA_IO_KIND") == "read";
  const long at = atol(Setting("TAPA_IO_AT").c_str());
  const bool onward = Setting("TAPA_IO_ONWARD") == "1";
  const int error = atoi(Setting("TAPA_IO_ERROR").c_str());
  const std::string count_path = Setting("TAPA_IO_COUNT");
};

// Never destroyed, as the program still closes files when it ends.
const Settings& TheSettings() {
  static const Settings* const settings = new Settings;
  return *settings;
}

std::atomic<long> num_operations(0);

// At the end of a program that ends in order.
__attribute__((destructor)) void WriteCount() {
  const Settings& settings = TheSettings();
  if (!settings.count_path.empty()) {
    FILE* file = fopen(settings.count_path.c_str(), "w");
    fprintf(file, "%ld\n", num_operations.load());
    fclose(file);
  }
}

bool IsBelowFolder(const std::string& path) {
  const std::string& folder = TheSettings().folder;
  return path.compare(0, folder.size(), folder) == 0;
}

std::string PathOf(int file) {
  const std::string link = "/proc/self/fd/" + std::to_string(file);
  char path[PATH_MAX];
  const ssize_t size = readlink(link.c_str(), path, sizeof(path));
  return size < 0 ? "" : std::string(path, size);
}

std::string Absolute(int folder, const char* path) {
  if (path[0] == '/') {
    return path;
  }
  char current[PATH_MAX];
  const std::string base = folder != AT_FDCWD ? PathOf(folder)
                           : getcwd(current, sizeof(current)) == nullptr
                               ? ""
                               : current;
  return base + "/" + path;
}

// Counts an operation. Returns whether it is to fail, with errno set.
bool Fails(bool is_read, const std::string& path) {
  const Settings& settings = TheSettings();
  if (is_read != settings.of_reads || !IsBelowFolder(path)) {
    return false;
  }
  const long number = ++num_operations;
  if (settings.at == 0 || number < settings.at ||
      (number > settings.at && !settings.onward)) {
    return false;
  }
  if (settings.error < 0) {
    kill(getpid(), SIGKILL);
    pause();
  }
  errno = settings.error;
  return true;
}

// Of an open file.
bool ReadFails(int file) { return Fails(true, PathOf(file)); }
bool ChangeFails(int file) { return Fails(false, PathOf(file)); }
// Of a path.
bool ChangeFails(int folder, const char* path) {
  return Fails(false, Absolute(folder, path));
}
bool OpenFails(int folder, const char* path, bool is_read) {
  return Fails(is_read, Absolute(folder, path));
}

bool IsRead(int flags) { return (flags & O_ACCMODE) == O_RDONLY; }
bool IsRead(const char* mode) {
  return mode[0] == 'r' && strchr(mode, '+') == nullptr;
}

// The function that one of ours stands before.
template <typename Function>
Function* Next(const char* name, Function*) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

mode_t Mode(int flags, va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

#define NEXT(name) \
  static auto* const next = Next(#name, static_cast<decltype(&name)>(nullptr))

extern "C" {

#define DEFINE_OPEN(name)                                                      \
  int name(const char* path, int flags, ...) {                                 \
    NEXT(name);                                                                \
    va_list arguments;                                                         \
    va_start(arguments, flags);                                                \
    const mode_t mode = Mode(flags, arguments);                                \
    va_end(arguments);                                                         \
    return OpenFails(AT_FDCWD, path, IsRead(flags)) ? -1                       \
                                                    : next(path, flags, mode); \
  }
DEFINE_OPEN(open)
DEFINE_OPEN(open64)

#define DEFINE_OPENAT(name)                                \
  int name(int folder, const char* path, int flags, ...) { \
    NEXT(name);                                            \
    va_list arguments;                                     \
    va_start(arguments, flags);                            \
    const mode_t mode = Mode(flags, arguments);            \
    va_end(arguments);                                     \
    return OpenFails(folder, path, IsRead(flags))          \
               ? -1                                        \
               : next(folder, path, flags, mode);          \
  }
DEFINE_OPENAT(openat)
DEFINE_OPENAT(openat64)

#define DEFINE_FOPEN(name)                                             \
  FILE* name(const char* path, const char* mode) {                     \
    NEXT(name);                                                        \
    return OpenFails(AT_FDCWD, path, IsRead(mode)) ? nullptr           \
                                                   : next(path, mode); \
  }
DEFINE_FOPEN(fopen)
DEFINE_FOPEN(fopen64)

ssize_t read(int file, void* data, size_t size) {
  NEXT(read);
  return ReadFails(file) ? -1 : next(file, data, size);
}
ssize_t readv(int file, const iovec* parts, int count) {
  NEXT(readv);
  return ReadFails(file) ? -1 : next(file, parts, count);
}
ssize_t pread(int file, void* data, size_t size, off_t offset) {
  NEXT(pread);
  return ReadFails(file) ? -1 : next(file, data, size, offset);
}
ssize_t pread64(int file, void* data, size_t size, off64_t offset) {
  NEXT(pread64);
  return ReadFails(file) ? -1 : next(file, data, size, offset);
}
size_t fread(void* data, size_t size, size_t count, FILE* file) {
  NEXT(fread);
  return ReadFails(fileno(file)) ? 0 : next(data, size, count, file);
}

ssize_t write(int file, const void* data, size_t size) {
  NEXT(write);
  return ChangeFails(file) ? -1 : next(file, data, size);
}
ssize_t writev(int file, const iovec* parts, int count) {
  NEXT(writev);
  return ChangeFails(file) ? -1 : next(file, parts, count);
}
ssize_t pwrite(int file, const void* data, size_t size, off_t offset) {
  NEXT(pwrite);
  return ChangeFails(file) ? -1 : next(file, data, size, offset);
}
ssize_t pwrite64(int file, const void* data, size_t size, off64_t offset) {
  NEXT(pwrite64);
  return ChangeFails(file) ? -1 : next(file, data, size, offset);
}
size_t fwrite(const void* data, size_t size, size_t count, FILE* file) {
  NEXT(fwrite);
  return ChangeFails(fileno(file)) ? 0 : next(data, size, count, file);
}
// Where what is buffered cannot be written, it is lost.
int fclose(FILE* file) {
  NEXT(fclose);
  const int number = fileno(file);
  const bool fails = !IsRead(fcntl(number, F_GETFL)) && ChangeFails(number);
  const int error = errno;
  if (fails) {
    __fpurge(file);
  }
  const int result = next(file);
  errno = error;
  return fails ? EOF : result;
}
int close(int file) {
  NEXT(close);
  const bool fails = !IsRead(fcntl(file, F_GETFL)) && ChangeFails(file);
  const int error = errno;
  const int result = next(file);
  errno = error;
  return fails ? -1 : result;
}
int fsync(int file) {
  NEXT(fsync);
  return ChangeFails(file) ? -1 : next(file);
}
int fdatasync(int file) {
  NEXT(fdatasync);
  return ChangeFails(file) ? -1 : next(file);
}
int rename(const char* from, const char* to) {
  NEXT(rename);
  return ChangeFails(AT_FDCWD, to) ? -1 : next(from, to);
}
int mkdir(const char* path, mode_t mode) {
  NEXT(mkdir);
  return ChangeFails(AT_FDCWD, path) ? -1 : next(path, mode);
}
int unlink(const char* path) {
  NEXT(unlink);
  return ChangeFails(AT_FDCWD, path) ? -1 : next(path);
}
int unlinkat(int folder, const char* path, int flags) {
  NEXT(unlinkat);
  return ChangeFails(folder, path) ? -1 : next(folder, path, flags);
}
int remove(const char* path) {
  NEXT(remove);
  return ChangeFails(AT_FDCWD, path) ? -1 : next(path);
}

}  // extern "C"
