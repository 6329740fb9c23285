#include "src/colmap/fusion_run.h"

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>

#include "mvs/fusion.h"
#include "src/base/atomic_file.h"
#include "src/base/failure.h"
#include "src/colmap/fusion_source.h"
#include "src/colmap/interrupt.h"
#include "src/fusion/packed_normal.h"

namespace tapa {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void PrintOptions(const colmap::mvs::StereoFusionOptions& options) {
  colmap::PrintHeading2("StereoFusion::Options");
  VisitFusionOptions(&options.agreement,
                     [](const OptionEntry& entry, const auto* value) {
                       std::cout << entry.name << ": " << *value << std::endl;
                     });
  std::cout << "mask_path: " << options.mask_path << std::endl
            << "max_image_size: " << options.max_image_size << std::endl
            << "num_threads: " << options.num_threads << std::endl
            << std::endl;
}

WorkspaceLocation Location(const std::string& path, const std::string& format,
                           const std::string& pmvs_option_name) {
  WorkspaceLocation location;
  location.path = path;
  location.format = format;
  location.pmvs_option_name = pmvs_option_name;
  return location;
}

// Views by their index in the model, as files have them.
void NumberAsModel(const FusionSource& source, FusedCloud* cloud) {
  for (FusedView& view : cloud->views) {
    view.view = source.ModelIndex(view.view);
    for (int& neighbor : view.neighbors) {
      neighbor = source.ModelIndex(neighbor);
    }
  }
}

// Returns whether it came to its end.
bool FuseAndReport(const colmap::mvs::StereoFusionOptions& options,
                   FusionSource* source,
                   const std::function<bool()>& is_stopped, FusedCloud* cloud) {
  const FusionProblem problem = source->Problem();
  FusionControl control;
  control.num_threads = options.num_threads;
  double done = 0;
  control.progress = [&](double share) {
    done = share;
    return !is_stopped();
  };
  const auto begin = Clock::now();
  auto view_begin = begin;
  size_t num_views = 0;
  size_t num_points = 0;
  control.view_done = [&](const FusedView& view) {
    ++num_views;
    num_points += view.points.size();
    const double to_go = done > 0 ? SecondsSince(begin) * (1 / done - 1) : 0;
    std::printf(
        "Fused %zu/%zu %s in %.1f s: %zu points, %zu in all; %.0f s to "
        "go\n",
        num_views, problem.views.size(), source->Name(view.view).c_str(),
        SecondsSince(view_begin), view.points.size(), num_points, to_go);
    std::fflush(stdout);
    view_begin = Clock::now();
  };
  return Fuse(options.agreement, problem, control, cloud);
}

// Numbers as they stand in memory, which is little-endian (map_files.cc), in
// blocks.
class BinaryWriter {
 public:
  explicit BinaryWriter(AtomicFile* file) : file_(file) {}
  ~BinaryWriter() = default;

  template <typename T>
  void Add(const T& value) {
    const auto* bytes = reinterpret_cast<const char*>(&value);
    buffer_.insert(buffer_.end(), bytes, bytes + sizeof(T));
    if (buffer_.size() >= kBlock) {
      Flush();
    }
  }

  void Flush() {
    file_->Write(buffer_.data(), buffer_.size());
    buffer_.clear();
  }

 private:
  static constexpr size_t kBlock = 1 << 20;

  AtomicFile* const file_;
  std::vector<char> buffer_;
};

std::string PlyHeader(size_t num_points, bool with_confidence) {
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                       std::to_string(num_points) + "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
    header += "property float " + std::string(name) + "\n";
  }
  for (const char* name : {"red", "green", "blue"}) {
    header += "property uchar " + std::string(name) + "\n";
  }
  if (with_confidence) {
    header += "property float confidence\n";
  }
  return header + "end_header\n";
}

void AddPoint(const Vec3& position, const Vec3& normal, const Rgb& color,
              BinaryWriter* writer) {
  writer->Add(position);
  writer->Add(normal);
  writer->Add(color);
}

template <typename AddAll>
void WriteFile(const std::string& path, const std::string& header,
               const AddAll& add_all) {
  AtomicFile file(path);
  file.Write(header.data(), header.size());
  BinaryWriter writer(&file);
  add_all(&writer);
  writer.Flush();
  file.Commit();
}

// An earlier cloud goes first: while there is one, both files are of one run.
template <typename Write>
void WriteOrDie(const std::string& path, const Write& write) {
  try {
    std::remove(path.c_str());
    write();
  } catch (const std::exception& error) {
    LOG(FATAL) << error.what();
  }
}

int CountBits(uint64_t bits) { return __builtin_popcountll(bits); }

void WriteVisibility(const std::string& path, const FusedCloud& cloud) {
  WriteFile(path, "", [&](BinaryWriter* writer) {
    writer->Add<uint64_t>(cloud.NumPoints());
    for (const FusedView& view : cloud.views) {
      for (const FusedPoint& point : view.points) {
        writer->Add<uint32_t>(1 + CountBits(point.visible));
        writer->Add<uint32_t>(view.view);
        for (size_t n = 0; n < view.neighbors.size(); ++n) {
          if ((point.visible >> n) & 1) {
            writer->Add<uint32_t>(view.neighbors[n]);
          }
        }
      }
    }
  });
}

}  // namespace

int FuseWorkspace(const colmap::mvs::StereoFusionOptions& options,
                  const std::string& workspace_path,
                  const std::string& workspace_format,
                  const std::string& pmvs_option_name,
                  const std::string& input_type,
                  const std::function<bool()>& is_stopped,
                  std::shared_ptr<const FusedCloud>* cloud) {
  PrintOptions(options);
  const Interrupt interrupt;
  const auto stopped = [&] { return interrupt.Signal() != 0 || is_stopped(); };
  try {
    CheckFusionOptions(options.agreement);
    FusionSource source(
        options, Location(workspace_path, workspace_format, pmvs_option_name),
        input_type == "photometric" ? Pass::kPhotometric : Pass::kGeometric);
    auto fused = std::make_shared<FusedCloud>();
    if (!FuseAndReport(options, &source, stopped, fused.get())) {
      std::cout << "Stopped; nothing was written." << std::endl;
      return interrupt.Signal() != 0 ? 128 + interrupt.Signal() : EXIT_FAILURE;
    }
    NumberAsModel(source, fused.get());
    if (fused->NumPoints() == 0) {
      std::cout << "WARNING: No points: no views agree." << std::endl;
    }
    std::cout << "Number of fused points: " << fused->NumPoints() << std::endl;
    *cloud = fused;
    return EXIT_SUCCESS;
  } catch (const std::bad_alloc&) {
    std::cerr << "ERROR: There is not enough memory; lower "
                 "--StereoFusion.max_image_size or agreement_cache_size."
              << std::endl;
  } catch (const std::exception& error) {
    std::cerr << "ERROR: " << error.what() << "." << std::endl;
  }
  return EXIT_FAILURE;
}

std::vector<colmap::PlyPoint> PlyPoints(const FusedCloud& cloud) {
  std::vector<colmap::PlyPoint> points;
  points.reserve(cloud.NumPoints());
  for (const FusedView& view : cloud.views) {
    for (const FusedPoint& fused : view.points) {
      const Vec3 normal = UnpackNormal(fused.normal);
      colmap::PlyPoint point;
      point.x = fused.position.x;
      point.y = fused.position.y;
      point.z = fused.position.z;
      point.nx = normal.x;
      point.ny = normal.y;
      point.nz = normal.z;
      point.r = fused.color.r;
      point.g = fused.color.g;
      point.b = fused.color.b;
      points.push_back(point);
    }
  }
  return points;
}

void WriteFusedCloud(const std::string& path, const FusedCloud& cloud) {
  WriteOrDie(path, [&] {
    WriteVisibility(path + ".vis", cloud);
    WriteFile(path, PlyHeader(cloud.NumPoints(), /* with_confidence */ true),
              [&](BinaryWriter* writer) {
                for (const FusedView& view : cloud.views) {
                  for (const FusedPoint& point : view.points) {
                    AddPoint(point.position, UnpackNormal(point.normal),
                             point.color, writer);
                    writer->Add(point.confidence);
                  }
                }
              });
  });
}

void WriteFusedCloud(const std::string& path,
                     const std::vector<colmap::PlyPoint>& points,
                     const std::vector<std::vector<int>>& visibility) {
  WriteOrDie(path, [&] {
    WriteFile(path + ".vis", "", [&](BinaryWriter* writer) {
      writer->Add<uint64_t>(visibility.size());
      for (const auto& views : visibility) {
        writer->Add<uint32_t>(static_cast<uint32_t>(views.size()));
        for (const int view : views) {
          writer->Add<uint32_t>(view);
        }
      }
    });
    WriteFile(path, PlyHeader(points.size(), /* with_confidence */ false),
              [&](BinaryWriter* writer) {
                for (const auto& p : points) {
                  AddPoint({p.x, p.y, p.z}, {p.nx, p.ny, p.nz}, {p.r, p.g, p.b},
                           writer);
                }
              });
  });
}

}  // namespace tapa
