#include "hv_explore_sac/nn/checkpoint.h"

#include <random>

#include <gtest/gtest.h>

#include "hv_core/binary_io.h"
#include "hv_core/file_io.h"
#include "hv_explore_sac/nn/network.h"
#include "small_map.h"

namespace hv::explore::nn {
namespace {

constexpr std::size_t kSumBytes = 64;

const Network<float>& SmallNetwork() {
  static const Network<float> network({8, 2, 8, 1, 1, 4}, {3, 0, 1});
  return network;
}

Checkpoint SmallCheckpoint() {
  Checkpoint checkpoint;
  checkpoint.text = "actor:\n  width: 8\n";
  const ParameterLayout& layout = SmallNetwork().layout();
  checkpoint.Put("actor", layout, layout.Initial(1));
  checkpoint.Put("optimiser", layout, Adam::State{layout.Initial(2), layout.Initial(3), 77});
  checkpoint.PutNumber("log_temperature", -0.125);
  return checkpoint;
}

/// Bytes with a sum that agrees.
std::string Signed(std::string content) { return content + Sha256(content); }

std::string Body(const std::string& bytes) { return bytes.substr(0, bytes.size() - kSumBytes); }

TEST(Checkpoint, ComesBackFromAFile) {
  const TemporaryFolder folder;
  SmallCheckpoint().Write(folder / "weights.bin");
  const Checkpoint back = Checkpoint::Read(folder / "weights.bin");
  const ParameterLayout& layout = SmallNetwork().layout();
  EXPECT_EQ(back.text, "actor:\n  width: 8\n");
  EXPECT_EQ(back.Parameters("actor", layout), layout.Initial(1));
  const Adam::State state = back.AdamState("optimiser", layout);
  EXPECT_EQ(state.mean, layout.Initial(2));
  EXPECT_EQ(state.square, layout.Initial(3));
  EXPECT_EQ(state.steps, 77);
  EXPECT_EQ(back.Number("log_temperature"), -0.125);
  EXPECT_EQ(back.Serialize(), SmallCheckpoint().Serialize());
}

TEST(Checkpoint, SaysWhatDoesNotFit) {
  const Checkpoint checkpoint = Checkpoint::Parse(SmallCheckpoint().Serialize(), "w.bin");
  const Network<float> wide({16, 2, 8, 1, 1, 4}, {3, 0, 1});
  EXPECT_EQ(ErrorOf([&] { checkpoint.Parameters("actor", wide.layout()); }),
            "w.bin: 'actor.embedding.weight' is 3 x 8, the network needs 3 x 16");
  const Network<float> deep({8, 2, 8, 2, 1, 4}, {3, 0, 1});
  EXPECT_EQ(ErrorOf([&] { checkpoint.Parameters("actor", deep.layout()); }),
            "w.bin: holds no 'actor.encoder1.norm_attention.gain'");
  EXPECT_EQ(ErrorOf([&] { checkpoint.Number("updates"); }), "w.bin: holds no 'updates'");
}

TEST(Checkpoint, SaysWhatIsWrongWithAFile) {
  const std::string good = SmallCheckpoint().Serialize();
  const auto error = [](const std::string& bytes) {
    return ErrorOf([&] { Checkpoint::Parse(bytes, "w.bin"); });
  };
  EXPECT_EQ(error(""), "w.bin: ends too early");
  EXPECT_EQ(error("a text that is none of ours"), "w.bin: is no file of weights");
  std::string newer = good;
  newer[8] = 9;
  EXPECT_EQ(error(newer), "w.bin: has format version 9, this program reads 1");
  EXPECT_EQ(error(good.substr(0, good.size() - 7)), "w.bin: does not agree with its checksum");
  EXPECT_EQ(error(Signed(Body(good) + "x")), "w.bin: goes on behind its end");
  EXPECT_NE(ErrorOf([] { Checkpoint::Read("/nowhere/w.bin"); }).find("/nowhere/w.bin"),
            std::string::npos);
}

/// Rows without columns take no bytes, however many there are.
TEST(Checkpoint, RefusesAbsurdMatricesAtOnce) {
  std::string bytes = Body(Checkpoint().Serialize());
  bytes.resize(bytes.size() - sizeof(std::uint32_t));  // that many matrices: none
  BinaryWriter writer;
  writer.PutSize(1);
  writer.PutText("endless");
  writer.PutSize(0xffffffff);
  writer.PutSize(0);
  EXPECT_EQ(ErrorOf([&] { Checkpoint::Parse(Signed(bytes + writer.Take()), "w.bin"); }),
            "w.bin: holds a matrix that is too large");
}

/// Any damage shows by the sum; and where the sum agrees, as in a file made to do harm, the reader
/// ends in an error or in finite numbers.
TEST(Checkpoint, SurvivesDamage) {
  const std::string good = SmallCheckpoint().Serialize();
  std::mt19937 random(3);
  for (int trial = 0; trial < 3000; ++trial) {
    std::string bytes = Body(good);
    // Most changes go to the first part, where counts and names are.
    const std::size_t range =
        trial % 2 == 0 ? std::min<std::size_t>(bytes.size(), 200) : bytes.size();
    for (int changes = 1 + trial % 3; changes > 0; --changes) {
      const std::size_t at = random() % std::min(range, bytes.size());
      if (trial % 5 == 0) {
        bytes.erase(at, 1 + random() % 8);
      } else if (trial % 7 == 0) {
        bytes.replace(at, 4, "\xff\xff\xff\xff");
      } else {
        bytes[at] = static_cast<char>(random());
      }
    }
    const std::string unsigned_error =
        ErrorOf([&] { Checkpoint::Parse(bytes + good.substr(Body(good).size()), "fuzz"); });
    EXPECT_EQ(unsigned_error.empty(), bytes == Body(good));
    const std::string error =
        ErrorOf([&] { Checkpoint::Parse(Signed(bytes), "fuzz").Serialize(); });
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace hv::explore::nn
