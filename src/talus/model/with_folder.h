#pragma once
// A model file that lies elsewhere than it was written for.

#include <filesystem>
#include <string>

namespace talus {

/// The model text with its key `folder` such that, read from `new_folder`, its paths count from `folder`.
std::string with_folder(const std::string& text, const std::filesystem::path& folder,
                        const std::filesystem::path& new_folder);

}  // namespace talus
