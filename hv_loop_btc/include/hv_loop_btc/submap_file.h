#pragma once

#include <string>
#include <vector>

#include "hv_loop_btc/btc_descriptor.h"
#include "hv_loop_btc/loop_detector.h"

namespace hv::loop {

/// Submaps and their descriptors, as stored with a map (descriptors.bin): what finds a place again
/// in another session.
struct StoredSubmaps {
  std::string scale;  ///< that the descriptors were made with: indoor or outdoor
  std::vector<SubmapRecord> records;
  std::vector<BtcDescriptor> descriptors;  ///< one a record
};

/// Bytes with a magic number and a version, little endian.
std::string Serialize(const StoredSubmaps& submaps);

/// Throws InputError, naming `source`, when the bytes are not what Serialize made, whatever they
/// are.
StoredSubmaps ParseSubmaps(const std::string& bytes, const std::string& source);

}  // namespace hv::loop
