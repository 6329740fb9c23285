// patch-match.cfg (src/colmap/problem_config.h), of a model with names of all
// kinds.

#include <set>

#include "src/colmap/problem_config.h"
#include "tests/fuzz/input.h"
#include "tests/fuzz/model.h"

namespace {

constexpr char kModel[] =
    "1 PINHOLE 8 8 8 8 4 4\n"
    "----\n"
    "1 1 0 0 0 0 0 0 1 a.jpg\n\n"
    "2 1 0 0 0 1 0 0 1 b.jpg\n\n"
    "3 1 0 0 0 2 0 0 1 x/c, d;e.jpg\n\n"
    "4 1 0 0 0 3 0 0 1 # 1.jpg\n\n"
    "5 1 0 0 0 4 0 0 1  f.jpg\n\n"
    "----\n"
    "1 0 0 4 0 0 0 0 1 0 2 0 3 0\n"
    "2 0 0 5 0 0 0 0 1 1 2 1 3 1\n";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tapa;
  static const colmap::mvs::Model model = ReadModelInput(kModel, ".txt");
  static const std::set<std::string> names = [] {
    std::set<std::string> all;
    for (size_t i = 0; i < model.images.size(); ++i) {
      all.insert(model.GetImageName(static_cast<int>(i)));
    }
    return all;
  }();
  const std::string name = "patch-match.cfg";
  const std::string path = Folder().Write(name, ToText(data, size));
  ReadOrRefuse(name, [&] {
    const auto is_name = [](const std::string& text) {
      return names.count(text) > 0;
    };
    ResolveProblems(ReadProblemConfig(path, is_name), model, 1);
  });
  return 0;
}
