// Instances of a sequence as a file of COCO's object detection.
// Source: COCO data format, cocodataset.org/#format-data: boxes [x, y, width, height] from the upper left corner of the
//   picture, masks as run lengths down the columns, background first.
#pragma once

#include <filesystem>
#include <string>

namespace vobench {

// The text of the file. Each frame is an image, each instance that is seen in it an annotation, its class the category;
// ids are those of labels.json. Throws std::runtime_error where the sequence has no instances, or a file is unreadable.
std::string CocoJson(const std::filesystem::path& sequence);

}  // namespace vobench
