#include "tests/fuzz/model.h"

#include <cstdlib>
#include <filesystem>

#include "src/colmap/problem_config.h"
#include "src/colmap/views.h"
#include "src/colmap/workspace.h"
#include "tests/fuzz/input.h"

namespace tapa {

colmap::mvs::Model ReadModelInput(std::string_view input,
                                  const std::string& extension) {
  static const bool made [[maybe_unused]] =
      std::filesystem::create_directories(Folder().Path("sparse")) &&
      std::filesystem::create_directories(Folder().Path("images"));
  const auto parts = SplitParts(input, 3);
  Folder().Write("sparse/cameras" + extension, parts[0]);
  Folder().Write("sparse/images" + extension, parts[1]);
  Folder().Write("sparse/points3D" + extension, parts[2]);
  WorkspaceLocation location;
  location.path = Folder().Path("");
  return ReadModel(location);
}

void ReadModelAndViews(std::string_view input, const std::string& extension) {
  ReadOrRefuse(Folder().Path(""), [&] {
    const colmap::mvs::Model model = ReadModelInput(input, extension);
    for (const SceneView& view : SceneViews(model, 2000)) {
      if (view.name.empty() || view.width <= 0 || view.height <= 0 ||
          view.width > 2000 || view.height > 2000) {
        std::abort();
      }
    }
    if (model.images.empty()) {
      return;
    }
    ViewConfig config;
    config.reference = model.GetImageName(0);
    config.sources = ViewConfig::Sources::kAuto;
    config.max_num_sources = 20;
    ResolveProblems({config}, model, 1);
  });
}

}  // namespace tapa
