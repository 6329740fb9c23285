#include "src/colmap/problem_config.h"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <unordered_set>

#include "src/base/failure.h"
#include "src/colmap/dense_model.h"
#include "src/colmap/text_files.h"
#include "util/math.h"
#include "util/misc.h"

namespace tapa {
namespace {

// COLMAP takes the triangulation angle of two views from this percentile of
// the angles at their common points.
constexpr float kTriangulationAnglePercentile = 75;

// The name of an image that a part of a line stands for: as it is, or without
// the blanks around it; empty: none.
std::string FindName(const std::string& text, const IsName& is_name) {
  const bool has_blank = !text.empty() && text[0] == ' ';
  for (const std::string& name : {text.substr(has_blank), text, Trim(text)}) {
    if (is_name(name)) {
      return name;
    }
  }
  return "";
}

// The parts of a line between commas or semicolons, without empty ones. A name
// that has such in it is one part.
std::vector<std::string> SplitList(const std::string& line,
                                   const IsName& is_name) {
  // In a name, so that a line of nothing else takes no hours.
  constexpr int kMaxSeparators = 16;
  const auto find_end = [&line](size_t begin) {
    return std::min(line.find_first_of(",;", begin), line.size());
  };
  std::vector<std::string> items;
  size_t begin = 0;
  while (begin <= line.size()) {
    size_t end = find_end(begin);
    std::string item = Trim(line.substr(begin, end - begin));
    size_t stop = end;
    for (int i = 0; i <= kMaxSeparators; ++i, stop = find_end(stop + 1)) {
      const std::string name =
          FindName(line.substr(begin, stop - begin), is_name);
      if (!name.empty()) {
        item = name;
        end = stop;
        break;
      }
      if (stop == line.size()) {
        break;
      }
    }
    if (!item.empty()) {
      items.push_back(item);
    }
    begin = end + 1;
  }
  return items;
}

// Names may begin with #, too.
bool IsComment(const std::string& line, const IsName& is_name) {
  return Trim(line)[0] == '#' && !is_name(line) &&
         !is_name(SplitList(line, is_name)[0]);
}

// Returns 0 if the text is not a number from 1 on.
int ParseCount(const std::string& text) {
  if (text.empty() || text.size() > 9 ||
      text.find_first_not_of("0123456789") != std::string::npos) {
    return 0;
  }
  return std::stoi(text);
}

ViewConfig ParseView(const std::string& path, const std::string& reference,
                     const std::string& sources_line, const IsName& is_name) {
  ViewConfig view;
  view.reference = reference;
  const std::vector<std::string> items = SplitList(sources_line, is_name);
  if (items.size() == 1 && items[0] == "__all__") {
    view.sources = ViewConfig::Sources::kAll;
  } else if (!items.empty() && items[0] == "__auto__") {
    view.sources = ViewConfig::Sources::kAuto;
    view.max_num_sources = items.size() == 2 ? ParseCount(items[1]) : 0;
    if (view.max_num_sources == 0) {
      throw Failure(path + ": the sources of " + reference + " are given as '" +
                    sources_line +
                    "', but __auto__ needs a number of at least 1, as in "
                    "'__auto__, 20'");
    }
  } else if (!items.empty()) {
    view.sources = ViewConfig::Sources::kNamed;
    view.source_names = items;
  } else {
    throw Failure(path + ": the line after " + reference +
                  " names no source images");
  }
  return view;
}

// Finds the sources of "__auto__". What it needs of the model takes long, so
// that is computed at the first use.
class SharedPointRanking {
 public:
  SharedPointRanking(const colmap::mvs::Model& model, double min_angle)
      : model_(model), min_angle_(colmap::DegToRad(min_angle)) {}

  std::vector<int> Best(int reference, int max_num_sources) {
    if (num_points_.empty()) {
      num_points_ = model_.ComputeSharedPoints();
      angles_ =
          model_.ComputeTriangulationAngles(kTriangulationAnglePercentile);
    }
    if (num_points_.at(reference).empty()) {
      return NeighborsByCameras(model_, reference, max_num_sources);
    }
    std::vector<std::pair<int, int>> views;
    for (const auto& view : num_points_.at(reference)) {
      if (angles_.at(reference).at(view.first) >= min_angle_) {
        views.push_back(view);
      }
    }
    std::stable_sort(
        views.begin(), views.end(),
        [](const auto& a, const auto& b) { return a.second > b.second; });
    std::vector<int> best;
    for (const auto& view : views) {
      if (static_cast<int>(best.size()) == max_num_sources) {
        break;
      }
      best.push_back(view.first);
    }
    return best;
  }

 private:
  const colmap::mvs::Model& model_;
  const float min_angle_;
  std::vector<std::map<int, int>> num_points_;
  std::vector<std::map<int, float>> angles_;
};

}  // namespace

std::vector<ViewConfig> ReadProblemConfig(const std::string& path,
                                          const IsName& is_name) {
  if (!colmap::ExistsFile(path)) {
    throw Failure("There is no " + path +
                  ", which lists the views to compute; image_undistorter "
                  "writes it");
  }
  std::vector<ViewConfig> config;
  std::string reference;
  std::string line;
  for (TextLines lines(path); lines.Next(&line);) {
    const std::string trimmed = Trim(line);
    if (trimmed.empty() || IsComment(line, is_name)) {
      continue;
    }
    if (reference.empty()) {
      reference = is_name(line) ? line : trimmed;
    } else {
      config.push_back(ParseView(path, reference, line, is_name));
      reference.clear();
    }
  }
  if (!reference.empty()) {
    throw Failure(path + ": " + reference +
                  " is not followed by a line with its source images");
  }
  if (config.empty()) {
    throw Failure(path + " lists no views to compute");
  }
  return config;
}

std::vector<ViewIndices> ResolveProblems(const std::vector<ViewConfig>& config,
                                         const colmap::mvs::Model& model,
                                         double min_triangulation_angle) {
  const int num_images = static_cast<int>(model.images.size());
  std::unordered_map<std::string, int> indices;
  for (int i = 0; i < num_images; ++i) {
    indices.emplace(model.GetImageName(i), i);
  }
  SharedPointRanking ranking(model, min_triangulation_angle);

  std::vector<ViewIndices> problems;
  std::unordered_set<int> known;
  for (const ViewConfig& view : config) {
    const auto reference = indices.find(view.reference);
    if (reference == indices.end()) {
      throw Failure("patch-match.cfg names the reference image " +
                    view.reference + ", which is not in the sparse model");
    }
    ViewIndices problem;
    problem.reference = reference->second;
    std::vector<int> candidates;
    switch (view.sources) {
      case ViewConfig::Sources::kAll:
        for (int i = 0; i < num_images; ++i) {
          candidates.push_back(i);
        }
        break;
      case ViewConfig::Sources::kAuto:
        candidates = ranking.Best(problem.reference, view.max_num_sources);
        break;
      case ViewConfig::Sources::kNamed:
        for (const std::string& name : view.source_names) {
          const auto source = indices.find(name);
          if (source == indices.end()) {
            throw Failure("patch-match.cfg names the source image " + name +
                          " of " + view.reference +
                          ", which is not in the sparse model");
          }
          candidates.push_back(source->second);
        }
        break;
    }
    std::unordered_set<int> used = {problem.reference};
    for (const int candidate : candidates) {
      if (used.insert(candidate).second) {
        problem.sources.push_back(candidate);
      }
    }
    if (known.insert(problem.reference).second) {
      problems.push_back(problem);
    }
  }
  return problems;
}

}  // namespace tapa
