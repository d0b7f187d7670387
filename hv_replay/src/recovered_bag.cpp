#include "recovered_bag.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>

#include <roslz4/lz4s.h>

#include "hv_core/error.h"

namespace hv::replay {
namespace {

// Record types of the bag format 2.0 (wiki.ros.org/Bags/Format/2.0).
constexpr char kMessageData = 0x02;
constexpr char kBagHeader = 0x03;
constexpr char kChunk = 0x05;
constexpr char kChunkInfo = 0x06;
constexpr char kConnection = 0x07;
constexpr char kBagMagic[] = "#ROSBAG V2.0\n";
constexpr std::uint32_t kMaxHeader = 1U << 20;
constexpr std::uint32_t kMaxChunk = 1U << 30;

using Fields = std::map<std::string, std::string>;

template <typename T>
std::optional<T> NumberIn(const std::string& bytes) {
  if (bytes.size() != sizeof(T)) return std::nullopt;
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

template <typename T>
std::optional<T> Number(const Fields& fields, const std::string& name) {
  const auto found = fields.find(name);
  return found == fields.end() ? std::nullopt : NumberIn<T>(found->second);
}

std::string Text(const Fields& fields, const std::string& name) {
  const auto found = fields.find(name);
  return found == fields.end() ? "" : found->second;
}

/// A position in bytes that never reads beyond their end.
struct Cursor {
  const char* at;
  const char* end;

  std::size_t left() const { return static_cast<std::size_t>(end - at); }

  std::optional<std::uint32_t> TakeLength() {
    std::uint32_t length = 0;
    if (left() < sizeof(length)) return std::nullopt;
    std::memcpy(&length, at, sizeof(length));
    if (length > left() - sizeof(length)) return std::nullopt;
    at += sizeof(length);
    return length;
  }

  std::string Take(std::uint32_t length) {
    std::string bytes(at, length);
    at += length;
    return bytes;
  }
};

/// "name=value" entries, each after its length; nullopt when malformed.
std::optional<Fields> ParseFields(const std::string& bytes) {
  Fields fields;
  Cursor cursor = {bytes.data(), bytes.data() + bytes.size()};
  while (cursor.left() > 0) {
    const std::optional<std::uint32_t> length = cursor.TakeLength();
    if (!length) return std::nullopt;
    const std::string entry = cursor.Take(*length);
    const std::size_t equals = entry.find('=');
    if (equals == std::string::npos) return std::nullopt;
    fields[entry.substr(0, equals)] = entry.substr(equals + 1);
  }
  return fields;
}

struct Record {
  Fields header;
  std::string data;

  char type() const { return Number<char>(header, "op").value_or(0); }
};

/// Reads records off a file, never trusting a length beyond the file's end.
class RecordFile {
 public:
  explicit RecordFile(const std::string& path) : file_(path, std::ios::binary) {
    file_.seekg(0, std::ios::end);
    left_ = std::max<std::streamoff>(file_.tellg(), 0);
    file_.seekg(0);
  }

  bool StartsWithMagic() {
    char magic[sizeof(kBagMagic) - 1] = {};
    left_ -= static_cast<std::streamoff>(sizeof(magic));
    return file_.read(magic, sizeof(magic)) && std::memcmp(magic, kBagMagic, sizeof(magic)) == 0;
  }

  bool Seek(std::uint64_t position) {
    file_.seekg(0, std::ios::end);
    const std::streamoff size = file_.tellg();
    if (size < 0 || position > static_cast<std::uint64_t>(size)) return false;
    left_ = size - static_cast<std::streamoff>(position);
    file_.seekg(static_cast<std::streamoff>(position));
    return static_cast<bool>(file_);
  }

  bool AtEnd() const { return left_ == 0; }

  /// Next record; nullopt where the file ends or is damaged.
  std::optional<Record> Next() {
    const std::optional<std::string> header = ReadBlock(kMaxHeader);
    if (!header) return std::nullopt;
    const std::optional<Fields> fields = ParseFields(*header);
    std::optional<std::string> data = ReadBlock(kMaxChunk);
    if (!fields || !data) return std::nullopt;
    return Record{*fields, std::move(*data)};
  }

 private:
  std::optional<std::string> ReadBlock(std::uint32_t limit) {
    std::uint32_t length = 0;
    if (!file_.read(reinterpret_cast<char*>(&length), sizeof(length))) return std::nullopt;
    left_ -= static_cast<std::streamoff>(sizeof(length));
    if (length > limit || static_cast<std::streamoff>(length) > left_) return std::nullopt;
    std::string bytes(length, '\0');
    if (!file_.read(bytes.data(), length)) return std::nullopt;
    left_ -= length;
    return bytes;
  }

  std::ifstream file_;
  std::streamoff left_ = 0;
};

/// Content of a chunk; nullopt when it does not decompress.
std::optional<std::string> Decompress(Record& chunk) {
  const std::string compression = Text(chunk.header, "compression");
  if (compression == "none") return std::move(chunk.data);
  const std::uint32_t size = Number<std::uint32_t>(chunk.header, "size").value_or(0);
  if (compression != "lz4" || size == 0 || size > kMaxChunk) return std::nullopt;
  std::string content(size, '\0');
  unsigned int written = size;
  const int status = roslz4_buffToBuffDecompress(
      chunk.data.data(), static_cast<unsigned int>(chunk.data.size()), content.data(), &written);
  if (status != ROSLZ4_OK || written != size) return std::nullopt;
  return content;
}

/// Topics by connection, filled while reading.
using Connections = std::map<std::uint32_t, BagTopicInfo>;

void AddConnection(const Fields& header, const std::string& data, Connections& connections) {
  const std::optional<std::uint32_t> id = Number<std::uint32_t>(header, "conn");
  const std::optional<Fields> description = ParseFields(data);
  if (!id || !description) return;
  BagTopicInfo& info = connections[*id];
  info.name = Text(header, "topic");
  info.type = Text(*description, "type");
}

struct RawMessage {
  std::uint32_t connection = 0;
  Time arrival;
  const char* data = nullptr;
  std::size_t size = 0;
};

std::optional<RawMessage> ToMessage(const Fields& header, const char* data, std::size_t size) {
  const std::optional<std::uint32_t> id = Number<std::uint32_t>(header, "conn");
  const std::optional<std::uint64_t> time = Number<std::uint64_t>(header, "time");
  if (!id || !time) return std::nullopt;
  const auto seconds = static_cast<std::int64_t>(*time & 0xFFFFFFFFU);
  const auto nanoseconds = static_cast<std::int64_t>(*time >> 32);
  return RawMessage{*id, Time::FromNanoseconds(seconds * 1000000000 + nanoseconds), data, size};
}

/// Messages of a chunk in order of arrival; their data point into `content`.
std::vector<RawMessage> MessagesIn(const std::string& content, Connections& connections) {
  std::vector<RawMessage> messages;
  Cursor cursor = {content.data(), content.data() + content.size()};
  while (const std::optional<std::uint32_t> header_length = cursor.TakeLength()) {
    const std::optional<Fields> header = ParseFields(cursor.Take(*header_length));
    const std::optional<std::uint32_t> data_length = cursor.TakeLength();
    if (!header || !data_length) break;
    const char type = Number<char>(*header, "op").value_or(0);
    if (type == kConnection) {
      AddConnection(*header, std::string(cursor.at, *data_length), connections);
    } else if (type == kMessageData) {
      const std::optional<RawMessage> message = ToMessage(*header, cursor.at, *data_length);
      if (message) messages.push_back(*message);
    }
    cursor.at += *data_length;
  }
  std::stable_sort(messages.begin(), messages.end(),
                   [](const RawMessage& a, const RawMessage& b) { return a.arrival < b.arrival; });
  return messages;
}

}  // namespace

bool HasSoundIndex(const std::string& path) {
  RecordFile file(path);
  if (!file.StartsWithMagic()) return true;
  const std::optional<Record> header = file.Next();
  if (!header || header->type() != kBagHeader) return false;
  const std::uint64_t position = Number<std::uint64_t>(header->header, "index_pos").value_or(0);
  std::uint32_t connections = 0;
  std::uint32_t chunks = 0;
  if (position == 0 || !file.Seek(position)) return false;
  while (!file.AtEnd()) {
    const std::optional<Record> record = file.Next();
    if (!record) return false;
    if (record->type() == kChunkInfo) ++chunks;
    if (record->type() == kConnection && ParseFields(record->data)) ++connections;
  }
  return Number<std::uint32_t>(header->header, "conn_count") == connections &&
         Number<std::uint32_t>(header->header, "chunk_count") == chunks;
}

RecoveredBag::RecoveredBag(const std::string& path) : path_(path) {
  std::map<std::string, BagTopicInfo> topics;
  bool first = true;
  ForEach([&](const Message& message) {
    BagTopicInfo& info = topics[message.topic.name];
    info.name = message.topic.name;
    info.type = message.topic.type;
    ++info.count;
    begin_ = first ? message.arrival : std::min(begin_, message.arrival);
    end_ = first ? message.arrival : std::max(end_, message.arrival);
    first = false;
    return true;
  });
  for (const auto& [name, info] : topics) topics_.push_back(info);
}

void RecoveredBag::ForEach(const Handler& handle) const {
  RecordFile file(path_);
  if (!file.StartsWithMagic()) throw InputError(path_ + ": not a readable bag");
  Connections connections;
  while (std::optional<Record> record = file.Next()) {
    if (record->type() == kConnection) AddConnection(record->header, record->data, connections);
    if (record->type() != kChunk) continue;
    const std::optional<std::string> content = Decompress(*record);
    if (!content) return;
    for (const RawMessage& message : MessagesIn(*content, connections)) {
      const auto* data = reinterpret_cast<const std::uint8_t*>(message.data);
      const BagTopicInfo& topic = connections[message.connection];
      if (!handle({topic, message.arrival, data, message.size})) return;
    }
  }
}

}  // namespace hv::replay
