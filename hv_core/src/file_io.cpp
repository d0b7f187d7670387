#include "hv_core/file_io.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <vector>

#include <openssl/evp.h>

#include "fail.h"
#include "hv_core/error.h"

namespace hv {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return descriptor_; }
  int Release() {
    const int released = descriptor_;
    descriptor_ = -1;
    return released;
  }

 private:
  int descriptor_;
};

/// Opens a regular file for reading and gives its size.
int OpenRegular(const std::string& path, std::size_t& size) {
  // A named pipe without a writer must not block.
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) Fail(path, "cannot be opened", errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) Fail(path, "cannot be read", errno);
  if (!S_ISREG(status.st_mode)) throw InputError(path + ": is not a regular file");
  size = static_cast<std::size_t>(status.st_size);
  return file.Release();
}

/// Fills up to `size` bytes; less only at the end of the file.
std::size_t ReadSome(int file, char* bytes, std::size_t size, const std::string& path) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t count = ::read(file, bytes + done, size - done);
    if (count == 0) break;
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) Fail(path, "cannot be read", errno);
    done += static_cast<std::size_t>(count);
  }
  return done;
}

bool WriteAll(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

bool WriteParts(const std::string& path, std::initializer_list<std::string_view> parts) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (file.get() < 0) return false;
  for (const std::string_view part : parts) {
    if (!WriteAll(file.get(), part)) return false;
  }
  return ::close(file.Release()) == 0;
}

/// SHA-256 over pieces.
class Digest {
 public:
  Digest() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    Check(context_ != nullptr && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }

  void Add(std::string_view bytes) {
    Check(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
  }

  std::string Hex() {
    unsigned char sum[EVP_MAX_MD_SIZE];
    unsigned int size = 0;
    Check(EVP_DigestFinal_ex(context_.get(), sum, &size) == 1);
    const char* digits = "0123456789abcdef";
    std::string text;
    for (unsigned int i = 0; i < size; ++i) {
      text += digits[sum[i] >> 4];
      text += digits[sum[i] & 15];
    }
    return text;
  }

 private:
  static void Check(bool good) {
    if (!good) throw std::runtime_error("SHA-256 is not available from libcrypto");
  }

  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_;
};

}  // namespace

std::string ReadFile(const std::string& path) {
  std::size_t size = 0;
  const Descriptor file(OpenRegular(path, size));
  std::string bytes(size, '\0');
  bytes.resize(ReadSome(file.get(), bytes.data(), size, path));
  return bytes;
}

void WriteFile(const std::string& path, std::initializer_list<std::string_view> parts) {
  const std::string temporary = path + ".part";
  if (WriteParts(temporary, parts) && std::rename(temporary.c_str(), path.c_str()) == 0) return;
  const int error = errno;
  ::unlink(temporary.c_str());
  Fail(path, "cannot be written", error);
}

bool IsFolder(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored);
}

void SyncPath(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) Fail(path, "cannot be opened", errno);
  // Some network file systems cannot sync folders and say EINVAL.
  if (::fsync(file.get()) != 0 && errno != EINVAL) Fail(path, "cannot be synced to disk", errno);
}

void LinkOrCopy(const std::string& from, const std::string& to) {
  if (::link(from.c_str(), to.c_str()) == 0) return;
  std::error_code error;
  // An existing target may be a link to the source itself: it is an error, not overwritten.
  std::filesystem::copy_file(from, to, error);
  if (error)
    throw InputError(to + ": cannot be copied from " + from + " (" + error.message() + ")");
}

std::string Sha256(std::string_view bytes) {
  Digest digest;
  digest.Add(bytes);
  return digest.Hex();
}

FileSum SumOfFile(const std::string& path) {
  constexpr std::size_t kPiece = 1U << 20U;
  std::size_t size = 0;
  const Descriptor file(OpenRegular(path, size));
  std::vector<char> piece(std::min(kPiece, size + 1));
  Digest digest;
  FileSum sum;
  while (const std::size_t count = ReadSome(file.get(), piece.data(), piece.size(), path)) {
    digest.Add({piece.data(), count});
    sum.size += count;
  }
  sum.sha256 = digest.Hex();
  return sum;
}

}  // namespace hv
