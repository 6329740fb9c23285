#include "src/colmap/views_record.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>

#include "src/base/atomic_file.h"
#include "src/base/failure.h"
#include "src/base/hash.h"
#include "src/colmap/text_files.h"
#include "util/misc.h"

namespace tapa {
namespace {

constexpr char kComment[] =
    "# What the maps of this pass were made from: camera, photograph (and "
    "masks and priors), names, cameras and photographs of the sources, name of "
    "the view.\n";
// Between photograph, masks and priors.
constexpr char kPlus = '+';

std::string Hex(const Hash& hash) {
  char text[17];
  std::snprintf(text, sizeof(text), "%016llx",
                static_cast<unsigned long long>(hash.value()));
  return text;
}

std::string DescribeAll(const std::multiset<std::string>& texts) {
  Hash hash;
  for (const std::string& text : texts) {
    hash.Add(text.c_str(), text.size() + 1);
  }
  return Hex(hash);
}

// Files that a view and its sources may have; empty if there are none.
std::string DescribeAny(const std::string& own,
                        const std::multiset<std::string>& of_sources) {
  const bool has_files =
      !own.empty() ||
      std::any_of(of_sources.begin(), of_sources.end(),
                  [](const std::string& file) { return !file.empty(); });
  return has_files ? own + "of" + DescribeAll(of_sources) : "";
}

// As one field of a line; without masks or priors as before there were any.
std::string PhotoMasksAndPriors(const ViewInputs& inputs) {
  std::string text = inputs.photo;
  if (!inputs.masks.empty() || !inputs.priors.empty()) {
    text += kPlus + inputs.masks;
  }
  if (!inputs.priors.empty()) {
    text += kPlus + inputs.priors;
  }
  return text;
}

// Takes off a text what stands behind the first kPlus in it.
std::string CutOffBehindPlus(std::string* text) {
  const size_t plus = text->find(kPlus);
  if (plus == std::string::npos) {
    return "";
  }
  const std::string rest = text->substr(plus + 1);
  text->resize(plus);
  return rest;
}

}  // namespace

std::string DescribeCamera(const SceneView& view) {
  const Camera& camera = view.camera;
  Hash hash;
  const auto add = [&hash](double value) {
    value += 0.0;  // There are two zeros.
    hash.Add(&value, sizeof(value));
  };
  for (const double value : {1.0 * view.photo_width, 1.0 * view.photo_height,
                             camera.fx, camera.fy, camera.cx, camera.cy}) {
    add(value);
  }
  std::for_each(std::begin(camera.R), std::end(camera.R), add);
  std::for_each(std::begin(camera.t), std::end(camera.t), add);
  return Hex(hash);
}

std::string DescribeFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw Failure("The image " + path +
                  " cannot be read: " + std::strerror(errno));
  }
  constexpr size_t kBufferSize = 1 << 20;
  const auto buffer = std::make_unique<char[]>(kBufferSize);
  Hash hash;
  do {
    file.read(buffer.get(), kBufferSize);
    hash.Add(buffer.get(), static_cast<size_t>(file.gcount()));
  } while (file);
  if (file.bad()) {
    throw Failure("The image " + path +
                  " cannot be read: " + std::strerror(errno));
  }
  return Hex(hash);
}

ViewInputs DescribeInputs(const std::vector<SceneView>& views, int reference,
                          const std::vector<int>& sources,
                          const std::map<int, ViewFiles>& files) {
  std::multiset<std::string> names;
  std::multiset<std::string> cameras;
  std::multiset<std::string> source_photos;
  std::multiset<std::string> source_masks;
  std::multiset<std::string> source_priors;
  for (const int source : sources) {
    names.insert(views[source].name);
    cameras.insert(DescribeCamera(views[source]));
    source_photos.insert(files.at(source).photo);
    source_masks.insert(files.at(source).mask);
    source_priors.insert(files.at(source).prior);
  }
  const ViewFiles& own = files.at(reference);
  return {DescribeCamera(views[reference]),
          own.photo,
          DescribeAll(names),
          DescribeAll(cameras),
          DescribeAll(source_photos),
          DescribeAny(own.mask, source_masks),
          DescribeAny(own.prior, source_priors)};
}

std::string DescribeDifference(const ViewInputs& recorded,
                               const ViewInputs& current) {
  // Other sources have other cameras, photographs, masks and priors.
  const bool same_sources = recorded.sources == current.sources;
  std::string text;
  const auto add = [&text](bool differs, const char* what) {
    if (differs) {
      text += (text.empty() ? "other " : " and other ") + std::string(what);
    }
  };
  add(recorded.camera != current.camera ||
          (same_sources && recorded.source_cameras != current.source_cameras),
      "poses or cameras");
  add(recorded.photo != current.photo ||
          (same_sources && recorded.source_photos != current.source_photos),
      "photographs");
  add(same_sources && recorded.masks != current.masks, "masks");
  add(same_sources && recorded.priors != current.priors, "priors");
  add(!same_sources, "source images");
  return text;
}

ViewsRecord ReadViewsRecord(const std::string& path) {
  ViewsRecord record;
  if (!colmap::ExistsPath(path)) {
    return record;
  }
  TextLines lines(path);
  std::string line;
  while (lines.Next(&line)) {
    if (line.empty() || line[0] == '#') {
      continue;
    }
    std::istringstream fields(line);
    ViewInputs inputs;
    fields >> inputs.camera >> inputs.photo >> inputs.sources >>
        inputs.source_cameras >> inputs.source_photos;
    inputs.masks = CutOffBehindPlus(&inputs.photo);
    inputs.priors = CutOffBehindPlus(&inputs.masks);
    std::string name;
    if (fields.get() != ' ' || !std::getline(fields, name)) {
      throw Failure(path +
                    ", which says what the maps beside it were made from, is "
                    "damaged in line " +
                    std::to_string(lines.Number()) +
                    "; remove it to go on with these maps whatever they were "
                    "made from, or remove the maps too to have them computed "
                    "again");
    }
    record[name] = inputs;
  }
  return record;
}

void WriteViewsRecord(const std::string& path, const ViewsRecord& record) {
  std::string text = kComment;
  for (const auto& [name, inputs] : record) {
    const std::string photo = PhotoMasksAndPriors(inputs);
    for (const std::string* field :
         {&inputs.camera, &photo, &inputs.sources, &inputs.source_cameras,
          &inputs.source_photos}) {
      text += *field + ' ';
    }
    text += name + "\n";
  }
  AtomicFile file(path);
  file.Write(text.data(), text.size());
  file.Commit();
}

}  // namespace tapa
