#ifndef TAPA_TESTS_EVAL_CLOUD_FILES_H_
#define TAPA_TESTS_EVAL_CLOUD_FILES_H_

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "src/base/vec3.h"
#include "tests/eval/test_files.h"

namespace tapa {

// An ascii PLY of points.
inline void WritePoints(const std::string& path,
                        const std::vector<Vec3>& points) {
  std::ofstream stream(path);
  stream.precision(9);
  stream << "ply\nformat ascii 1.0\nelement vertex " << points.size()
         << "\nproperty float x\nproperty float y\nproperty float z\n"
            "end_header\n";
  for (const Vec3& point : points) {
    stream << point.x << " " << point.y << " " << point.z << "\n";
  }
}

constexpr char kIdentity[] = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1";

struct ProjectScan {
  std::string name;
  std::string matrix = kIdentity;
};

// A project as MeshLab writes it.
inline void WriteProject(const std::string& path,
                         const std::vector<ProjectScan>& scans) {
  std::string text =
      "<!DOCTYPE MeshLabDocument>\n<MeshLabProject>\n <MeshGroup>\n";
  for (const ProjectScan& scan : scans) {
    text += "  <MLMesh label=\"" + scan.name + "\" filename=\"" + scan.name +
            "\">\n   <MLMatrix44>\n" + scan.matrix +
            " \n</MLMatrix44>\n  </MLMesh>\n";
  }
  text += " </MeshGroup>\n <RasterGroup/>\n</MeshLabProject>\n";
  WriteText(path, text);
}

}  // namespace tapa

#endif  // TAPA_TESTS_EVAL_CLOUD_FILES_H_
