#include "src/eval/meshlab_project.h"

#include <Eigen/LU>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <pugixml.hpp>
#include <sstream>
#include <stdexcept>

namespace tapa {
namespace {

namespace fs = std::filesystem;

// How far a matrix that was written as text may be from a rotation: a
// millimetre in ten metres.
constexpr double kMaxRotationError = 1e-4;

pugi::xml_document ParseXml(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || fs::is_directory(path)) {
    throw std::runtime_error("cannot open " + path);
  }
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  pugi::xml_document document;
  const pugi::xml_parse_result result =
      document.load_buffer(text.data(), text.size());
  if (!result) {
    const auto line =
        1 + std::count(text.begin(), text.begin() + result.offset, '\n');
    throw std::runtime_error(path + " is not a MeshLab project: line " +
                             std::to_string(line) + ": " +
                             result.description());
  }
  return document;
}

// The 16 numbers of a matrix, row by row. False if there are others.
bool ParseMatrix(const std::string& text, Eigen::Matrix4d* matrix) {
  std::istringstream stream(text);
  std::string word;
  int count = 0;
  for (; stream >> word; ++count) {
    double value = 0;
    const char* end = word.data() + word.size();
    const auto result = std::from_chars(word.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end || count == 16) {
      return false;
    }
    (*matrix)(count / 4, count % 4) = value;
  }
  return count == 16 && matrix->allFinite();
}

bool IsRotation(const Eigen::Matrix3d& matrix) {
  const Eigen::Matrix3d error =
      matrix * matrix.transpose() - Eigen::Matrix3d::Identity();
  return error.cwiseAbs().maxCoeff() <= kMaxRotationError &&
         matrix.determinant() > 0;
}

ScanPose ParsePose(const pugi::xml_node& mesh, const std::string& where) {
  const pugi::xml_node node = mesh.child("MLMatrix44");
  if (!node) {
    throw std::runtime_error(where + " has no pose (MLMatrix44)");
  }
  Eigen::Matrix4d matrix;
  if (!ParseMatrix(node.text().get(), &matrix)) {
    throw std::runtime_error(where +
                             " has a pose that is not 16 numbers (MLMatrix44)");
  }
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    throw std::runtime_error(where +
                             " has a pose whose last row is not 0 0 0 1");
  }
  ScanPose pose;
  pose.rotation = matrix.topLeftCorner<3, 3>();
  pose.translation = matrix.topRightCorner<3, 1>();
  if (!IsRotation(pose.rotation)) {
    throw std::runtime_error(
        where +
        " has a pose that is not a rotation and a translation: apply scale, "
        "shear or reflection to the points of the scan");
  }
  return pose;
}

}  // namespace

Vec3 ScanPose::ToWorld(const Vec3& point) const {
  const Eigen::Vector3d world =
      rotation * Eigen::Vector3d(point.x, point.y, point.z) + translation;
  return {static_cast<float>(world.x()), static_cast<float>(world.y()),
          static_cast<float>(world.z())};
}

Eigen::Vector3d ScanPose::ToScan(const Vec3& point) const {
  return rotation.transpose() *
         (Eigen::Vector3d(point.x, point.y, point.z) - translation);
}

std::vector<ScanFile> ReadMeshLabProject(const std::string& path) {
  const pugi::xml_document document = ParseXml(path);
  const pugi::xml_node project = document.child("MeshLabProject");
  if (!project) {
    throw std::runtime_error(path + " is not a MeshLab project");
  }
  std::vector<ScanFile> scans;
  for (const pugi::xml_node& mesh :
       project.child("MeshGroup").children("MLMesh")) {
    const std::string name = mesh.attribute("filename").value();
    if (name.empty()) {
      throw std::runtime_error(path + ": scan " +
                               std::to_string(scans.size() + 1) +
                               " has no file name");
    }
    // An absolute name stands for itself.
    scans.push_back({(fs::path(path).parent_path() / name).string(),
                     ParsePose(mesh, path + ": scan " + name)});
  }
  if (scans.empty()) throw std::runtime_error(path + " lists no scan");
  return scans;
}

}  // namespace tapa
