#ifndef TAPA_TESTS_FUZZ_INPUT_H_
#define TAPA_TESTS_FUZZ_INPUT_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tapa {

// A folder in memory for what a reader reads, which is there as long as the
// program runs.
class InputFolder {
 public:
  InputFolder();
  ~InputFolder();

  InputFolder(const InputFolder&) = delete;
  InputFolder& operator=(const InputFolder&) = delete;

  std::string Path(const std::string& name) const;
  // Returns the path.
  std::string Write(const std::string& name, std::string_view content) const;

 private:
  std::string path_;
};

// The one of the program.
const InputFolder& Folder();

std::string_view ToText(const uint8_t* data, size_t size);

// The parts between lines "----", of which there are `count` as a rule; those
// that are missing are empty.
std::vector<std::string_view> SplitParts(std::string_view text, size_t count);

// Calls a reader, which may refuse what it reads by a Failure that names the
// file. Everything else ends the program as a finding.
void ReadOrRefuse(const std::string& file, const std::function<void()>& read);

}  // namespace tapa

#endif  // TAPA_TESTS_FUZZ_INPUT_H_
