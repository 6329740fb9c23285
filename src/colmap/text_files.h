#ifndef TAPA_SRC_COLMAP_TEXT_FILES_H_
#define TAPA_SRC_COLMAP_TEXT_FILES_H_

#include <fstream>
#include <functional>
#include <string>
#include <vector>

// This header is included by COLMAP's own sources.

namespace tapa {

// The lines of a text file as it comes from any editor: without a byte order
// mark and the line ends of Windows.
class TextLines {
 public:
  // Throws Failure if the file cannot be opened.
  explicit TextLines(const std::string& path);

  // Returns false at the end. Throws Failure if the file cannot be read.
  bool Next(std::string* line);

  // Of the line that was read last, from 1 on.
  int Number() const { return number_; }

 private:
  const std::string path_;
  std::ifstream file_;
  int number_ = 0;
};

// Throws ReadFailure.
std::string ReadWholeFile(const std::string& path);

// Without blanks at both ends.
std::string Trim(const std::string& text);
bool IsNotBlank(const std::string& text);

// The names in a list of images, one a line. A line that is_name knows is a
// name as it stands; others are trimmed, and neither those that are empty then
// nor comments (#) count. Throws Failure.
std::vector<std::string> ReadImageNames(
    const std::string& path,
    const std::function<bool(const std::string&)>& is_name);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_TEXT_FILES_H_
