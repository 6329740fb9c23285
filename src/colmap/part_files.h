#ifndef TAPA_SRC_COLMAP_PART_FILES_H_
#define TAPA_SRC_COLMAP_PART_FILES_H_

#include <functional>
#include <iosfwd>
#include <string>

// This header is included by COLMAP's own sources.

namespace tapa {

// What COLMAP itself writes becomes so under another name first, and gets its
// own when it is complete.

// Makes an empty folder for what is to become the folder of this path.
std::string MakePart(const std::string& path);
// Gives it that path, in place of what is there. Throws Failure.
void CommitPart(const std::string& path);

// Closes a file. Throws Failure unless all that was written has arrived there.
void CheckWritten(const std::string& path, std::ofstream* file);

// Lets write make a PLY file, with the path that it is given, and renames it to
// its own. Prints an error, and returns false, if write fails or the file is
// not whole. If write ends the program, that ends with an error, too: the
// mesher takes every trouble for a success.
bool WriteWhole(const std::string& path,
                const std::function<bool(const std::string&)>& write);

// Whether the undistorter was through with a workspace.
bool IsWholeWorkspace(const std::string& path);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PART_FILES_H_
