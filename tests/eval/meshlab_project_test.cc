#include "src/eval/meshlab_project.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "tests/eval/cloud_files.h"

namespace tapa {
namespace {

class MeshLabProjectTest : public ::testing::Test {
 protected:
  void ExpectError(const std::string& text, const std::string& part) {
    WriteText(path_, text);
    ExpectReadError(ReadMeshLabProject, path_, part);
  }

  void ExpectMatrixError(const std::string& matrix, const std::string& part) {
    WriteProject(path_, {{"good.ply"}, {"bad.ply", matrix}});
    ExpectReadError(ReadMeshLabProject, path_,
                    "scan bad.ply has a pose " + part);
  }

  TemporaryFolder folder_;
  const std::string path_ = folder_.File("scans.mlp");
};

TEST_F(MeshLabProjectTest, ScansWithPoses) {
  WriteProject(path_, {{"a.ply"},
                       {"sub/b.ply", "0 -1 0 4\n1 0 0 5\n0 0 1 6\n0 0 0 1"},
                       {"/c.ply"}});
  const std::vector<ScanFile> scans = ReadMeshLabProject(path_);
  ASSERT_EQ(scans.size(), 3u);
  EXPECT_EQ(scans[0].path, folder_.path() + "/a.ply");
  EXPECT_EQ(scans[1].path, folder_.path() + "/sub/b.ply");
  EXPECT_EQ(scans[2].path, "/c.ply");
  EXPECT_EQ(scans[0].pose.rotation, Eigen::Matrix3d::Identity());

  const ScanPose& pose = scans[1].pose;
  const Vec3 world = pose.ToWorld({1, 2, 3});
  EXPECT_EQ(world.x, 2);
  EXPECT_EQ(world.y, 6);
  EXPECT_EQ(world.z, 9);
  EXPECT_EQ(pose.ToScan(world), Eigen::Vector3d(1, 2, 3));
}

TEST_F(MeshLabProjectTest, RoundedRotation) {
  WriteProject(path_, {{"a.ply",
                        "0.866025 -0.5 0 1e-3\n0.5 0.866025 0 -2.5E1\n"
                        "0 0 1 0\n0 0 0 1"}});
  EXPECT_EQ(ReadMeshLabProject(path_)[0].pose.translation,
            Eigen::Vector3d(1e-3, -25, 0));
}

TEST_F(MeshLabProjectTest, OtherFiles) {
  ExpectError("", "is not a MeshLab project");
  ExpectError("nonsense", "is not a MeshLab project");
  ExpectError("<MeshLabProject>\n<MeshGroup>\n<MLMesh\n",
              "is not a MeshLab project: line ");
  ExpectError("<COLLADA/>", "is not a MeshLab project");
  ExpectError("<MeshLabProject/>", "lists no scan");
  ExpectError("<MeshLabProject><MeshGroup/></MeshLabProject>", "lists no scan");
}

TEST_F(MeshLabProjectTest, IncompleteScans) {
  const std::string begin = "<MeshLabProject><MeshGroup><MLMesh label=\"a\"";
  const std::string end = "</MLMesh></MeshGroup></MeshLabProject>";
  ExpectError(begin + "><MLMatrix44>" + kIdentity + "</MLMatrix44>" + end,
              "scan 1 has no file name");
  ExpectError(begin + " filename=\"a.ply\">" + end,
              "scan a.ply has no pose (MLMatrix44)");
}

TEST_F(MeshLabProjectTest, BadMatrices) {
  ExpectMatrixError("", "that is not 16 numbers");
  ExpectMatrixError("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0", "that is not 16 numbers");
  ExpectMatrixError(std::string(kIdentity) + " 0", "that is not 16 numbers");
  ExpectMatrixError("x 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1",
                    "that is not 16 numbers");
  ExpectMatrixError("1 0 0 nan 0 1 0 0 0 0 1 0 0 0 0 1",
                    "that is not 16 numbers");
  ExpectMatrixError("1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1",
                    "whose last row is not 0 0 0 1");
  ExpectMatrixError("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1000",
                    "whose last row is not 0 0 0 1");
  for (const char* matrix :
       {"1000 0 0 0 0 1000 0 0 0 0 1000 0 0 0 0 1",  // scale
        "1 0 0 0 0 1 0 0 0 0 1.001 0 0 0 0 1",       // stretch
        "1 0.001 0 0 0 1 0 0 0 0 1 0 0 0 0 1",       // shear
        "-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1",          // reflection
        "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 1"}) {
    ExpectMatrixError(matrix, "that is not a rotation and a translation");
  }
}

TEST_F(MeshLabProjectTest, MissingFile) {
  EXPECT_THROW(ReadMeshLabProject(folder_.File("none.mlp")),
               std::runtime_error);
  EXPECT_THROW(ReadMeshLabProject(folder_.path()), std::runtime_error);
}

}  // namespace
}  // namespace tapa
