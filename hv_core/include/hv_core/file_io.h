#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace hv {

/// All bytes of a regular file. Throws InputError, naming the file, when it is missing, no regular
/// file or cannot be read.
std::string ReadFile(const std::string& path);

/// Writes `parts` one after the other through a temporary file and a rename, so that `path` is
/// never seen half written. Throws InputError and leaves `path` as it was when that fails.
void WriteFile(const std::string& path, std::initializer_list<std::string_view> parts);

/// False also where nobody may look.
bool IsFolder(const std::string& path);

/// Flushes a file or folder to the disk. Throws InputError.
void SyncPath(const std::string& path);

/// Hard link, or a copy where links are not possible. Throws InputError.
void LinkOrCopy(const std::string& from, const std::string& to);

/// SHA-256 in lower-case hexadecimal, as the program sha256sum prints it.
std::string Sha256(std::string_view bytes);

/// Sum and size of a file that is read in pieces. Throws InputError.
struct FileSum {
  std::string sha256;
  std::size_t size = 0;
};
FileSum SumOfFile(const std::string& path);

}  // namespace hv
