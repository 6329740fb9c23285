#ifndef TAPA_SRC_COLMAP_IMAGE_NAME_H_
#define TAPA_SRC_COLMAP_IMAGE_NAME_H_

#include <string>

namespace tapa {

// Throws Failure unless a name that a file gives to an image can be that of a
// file in a folder of images or below it. Masks, maps and pictures of an image
// are named after it, in folders of their own, and a model may come from
// anywhere: with another name they would be written somewhere else.
void CheckImageName(const std::string& name);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_IMAGE_NAME_H_
