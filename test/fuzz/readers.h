#pragma once

#include <functional>
#include <map>
#include <string>

namespace hv::fuzz {

/// What reads bytes that anybody may have written. It must return or throw InputError of one line,
/// whatever they are.
using Reader = std::function<void(const std::string& bytes)>;
using Readers = std::map<std::string, Reader>;

/// Levels in seeds were made with it.
inline constexpr char kNdtKey[] = "key";

/// Between the text and the picture of a grid.
inline constexpr char kGridParts[] = "\n----\n";

/// Of files and of texts in files, by name.
Readers FileReaders();

/// Of ROS messages: the bytes say what is in them.
Readers MessageReaders();

/// A short file of each kind, as this project writes it, by the name of its reader.
std::map<std::string, std::string> Seeds();

}  // namespace hv::fuzz
