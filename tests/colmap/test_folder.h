#ifndef TAPA_TESTS_COLMAP_TEST_FOLDER_H_
#define TAPA_TESTS_COLMAP_TEST_FOLDER_H_

#include <boost/filesystem.hpp>
#include <string>

namespace tapa {

// A folder that is there as long as this lives.
class TestFolder {
 public:
  TestFolder()
      : path_(boost::filesystem::temp_directory_path() /
              boost::filesystem::unique_path("tapa-%%%%-%%%%-%%%%")) {
    boost::filesystem::create_directories(path_);
  }
  ~TestFolder() { boost::filesystem::remove_all(path_); }

  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::string Path(const std::string& name) const {
    return (path_ / name).string();
  }

  // Number of files in the folder, those in folders in it not counted.
  int NumFiles() const {
    int num = 0;
    for (boost::filesystem::directory_iterator it(path_), end; it != end;
         ++it) {
      num += boost::filesystem::is_regular_file(it->path());
    }
    return num;
  }

 private:
  const boost::filesystem::path path_;
};

}  // namespace tapa

#endif  // TAPA_TESTS_COLMAP_TEST_FOLDER_H_
