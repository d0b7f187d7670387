#include "hv_explore_sac/train/trainer.h"

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include <gtest/gtest.h>

#include "hv_core/error.h"
#include "hv_explore_sac/policy/policy_input.h"
#include "random_maps.h"

namespace hv::explore {
namespace {

class TrainerTest : public testing::Test {
 protected:
  TrainerTest() {
    for (unsigned seed = 1; seed <= 5; ++seed) maps_.push_back(RandomMap(seed));
    config_.split.held_out = 1;
    config_.split.validation = 1;
    config_.labels.share = 0.2;
    config_.improvement.rounds = 2;
    config_.improvement.updates = 20;
    config_.improvement.batch = 8;
    nn::NetworkConfig& network = config_.sac.actor;
    network.width = 8;
    network.heads = 2;
    network.feed_forward = 8;
    network.encoder_layers = 1;
    network.pyramid_levels = 0;
    network.memory = 0;
    config_.sac.critic = network;
  }

  std::string Folder(const std::string& name) const {
    const std::string folder = testing::TempDir() + "trainer_" + name;
    std::filesystem::remove_all(folder);
    return folder;
  }
  Trainer Make(const std::string& folder, const Trainer::Report& report) {
    return Trainer(config_, maps_, folder, ranks_, report);
  }

  std::vector<ExplorationMap> maps_;
  TrainConfig config_;
  Ranks ranks_;
};

void ExpectSame(double a, double b) {
  if (std::isnan(a)) {
    EXPECT_TRUE(std::isnan(b));
  } else {
    EXPECT_FLOAT_EQ(static_cast<float>(a), static_cast<float>(b));
  }
}

TEST_F(TrainerTest, AnInterruptedTrainingComesOutTheSame) {
  config_.labels.maps = 2;
  config_.labels.crossed = 1;
  config_.improvement.networks = 2;
  config_.improvement.imitations = 10;
  const auto quiet = [](const std::string&, double) {};
  Trainer whole = Make(Folder("whole"), quiet);
  whole.Run();

  const std::string folder = Folder("broken");
  for (const std::string when : {"round 1: learning", "round 2: learning"}) {
    Trainer broken = Make(folder, [&](const std::string& what, double) {
      if (what == when) throw std::runtime_error("switched off");
    });
    if (when[6] == '2') broken.Resume();
    EXPECT_THROW(broken.Run(), std::runtime_error);
  }
  bool measured_anew = false;
  Trainer resumed = Make(folder, [&](const std::string& what, double) {
    measured_anew = measured_anew || what == "round 2: measuring";
  });
  resumed.Resume();
  resumed.Run();

  EXPECT_FALSE(measured_anew);
  ASSERT_EQ(resumed.curve().size(), whole.curve().size());
  for (std::size_t i = 0; i < whole.curve().size(); ++i) {
    ExpectSame(whole.curve()[i].loss, resumed.curve()[i].loss);
    ExpectSame(whole.curve()[i].gain, resumed.curve()[i].gain);
    ExpectSame(whole.curve()[i].travel, resumed.curve()[i].travel);
  }
}

TEST_F(TrainerTest, GoesOnWithTheSameConfigurationOnly) {
  const auto quiet = [](const std::string&, double) {};
  const std::string folder = Folder("other");
  EXPECT_THROW(Make(folder, quiet).Resume(), InputError);
  config_.improvement.rounds = 1;
  Make(folder, quiet).Run();
  config_.labels.wander = 0.5;
  EXPECT_THROW(Make(folder, quiet).Resume(), InputError);
}

TEST_F(TrainerTest, GoesOnForMoreRounds) {
  const auto quiet = [](const std::string&, double) {};
  Trainer whole = Make(Folder("long"), quiet);
  whole.Run();
  config_.improvement.rounds = 1;
  const std::string folder = Folder("longer");
  Make(folder, quiet).Run();
  config_.improvement.rounds = 2;
  Trainer longer = Make(folder, quiet);
  longer.Resume();
  longer.Run();
  ASSERT_EQ(longer.curve().size(), whole.curve().size());
  ExpectSame(longer.curve().back().travel, whole.curve().back().travel);
  ExpectSame(longer.curve().back().loss, whole.curve().back().loss);
}

TEST_F(TrainerTest, LearnsNothingFromAnEarlierTraining) {
  const auto quiet = [](const std::string&, double) {};
  config_.improvement.rounds = 1;
  const std::string folder = Folder("used");
  config_.labels.share = 0.6;
  Make(folder, quiet).Run();
  config_.labels.share = 0.2;
  Trainer again = Make(folder, quiet);
  again.Run();
  Trainer fresh = Make(Folder("fresh"), quiet);
  fresh.Run();
  EXPECT_EQ(again.curve().back().states, fresh.curve().back().states);
  ExpectSame(again.curve().back().gain, fresh.curve().back().gain);
}

TEST_F(TrainerTest, TakesOverWhatAnotherHasMeasured) {
  const auto quiet = [](const std::string&, double) {};
  config_.improvement.rounds = 1;
  const std::string measured = Folder("measured");
  Make(measured, quiet).Run();
  config_.sac.temperature = 0.5;
  const std::string folder = Folder("taking");
  Trainer taking = Make(folder, quiet);
  taking.TakeLabels(measured);
  taking.Run();
  Trainer alone = Make(Folder("alone"), quiet);
  alone.Run();
  EXPECT_EQ(taking.curve().back().states, alone.curve().back().states);
  ExpectSame(taking.curve().back().loss, alone.curve().back().loss);

  // More maps than were measured: those of the last part are measured anew.
  config_.labels.crossed = 2;
  Trainer more = Make(Folder("more"), quiet);
  more.TakeLabels(measured);
  more.Run();
  Trainer more_alone = Make(Folder("more_alone"), quiet);
  more_alone.Run();
  EXPECT_GT(more.curve().back().states, alone.curve().back().states);
  ExpectSame(more.curve().back().loss, more_alone.curve().back().loss);
}

TEST_F(TrainerTest, ImprovesOnAPolicyThatItBeginsWith) {
  const auto quiet = [](const std::string&, double) {};
  config_.improvement.rounds = 1;
  const PolicySettings settings{config_.policy, config_.sac.actor};
  const nn::Sac random(config_.sac, PolicyNetwork::Shape(), PolicyInput::kGlobals);
  const PolicyNetwork first(settings, random.actor_parameters());
  const std::string policy = testing::TempDir() + "trainer_first.bin";
  first.ToCheckpoint().Write(policy);

  // Who learns next to nothing is still what it began with.
  config_.sac.actor_optimiser.learning_rate = 1e-9;
  const std::string idle = Folder("idle");
  Trainer unmoved = Make(idle, quiet);
  unmoved.BeginWith(policy);
  unmoved.Run();
  EXPECT_TRUE(
      PolicyNetwork::Read(idle + "/last.bin")->parameters().isApprox(first.parameters(), 1e-5F));
  config_.sac.actor_optimiser.learning_rate = 1e-3;

  const std::string folder = Folder("begun");
  Trainer broken = Make(folder, [&](const std::string& what, double) {
    if (what == "round 1: learning") throw std::runtime_error("switched off");
  });
  broken.BeginWith(policy);
  EXPECT_THROW(broken.Run(), std::runtime_error);
  Trainer resumed = Make(folder, quiet);
  resumed.Resume();
  resumed.Run();
  Trainer whole = Make(Folder("begun_whole"), quiet);
  whole.BeginWith(policy);
  whole.Run();
  ExpectSame(resumed.curve().back().loss, whole.curve().back().loss);
  ExpectSame(resumed.curve().back().travel, whole.curve().back().travel);
  Trainer fresh = Make(Folder("not_begun"), quiet);
  fresh.Run();
  EXPECT_NE(fresh.curve().back().loss, whole.curve().back().loss);

  EXPECT_THROW(Make(Folder("labels_of_begun"), quiet).TakeLabels(folder), InputError);
  config_.policy.most_goals = 3;
  EXPECT_THROW(Make(Folder("other_policy"), quiet).BeginWith(policy), InputError);
}

TEST_F(TrainerTest, TakesOverNothingMeasuredOtherwise) {
  const auto quiet = [](const std::string&, double) {};
  config_.improvement.rounds = 1;
  const std::string measured = Folder("measured_so");
  Make(measured, quiet).Run();
  const std::vector<ExplorationMap> maps(maps_.rbegin(), maps_.rend());
  Trainer other_maps(config_, maps, Folder("others"), ranks_, quiet);
  other_maps.TakeLabels(measured);
  EXPECT_THROW(other_maps.Run(), InputError);
  config_.labels.share = 0.3;
  EXPECT_THROW(Make(Folder("otherwise"), quiet).TakeLabels(measured), InputError);
  EXPECT_THROW(Make(Folder("nothing"), quiet).TakeLabels(Folder("nowhere")), InputError);
}

TEST_F(TrainerTest, NeedsChoicesToLearnFrom) {
  config_.labels.share = 1e-12;
  Trainer trainer = Make(Folder("choices"), [](const std::string&, double) {});
  EXPECT_THROW(trainer.Run(), InputError);
}

TEST_F(TrainerTest, NeedsMapsToLearnFrom) {
  config_.split.held_out = 4;
  EXPECT_THROW(Make(Folder("none"), [](const std::string&, double) {}), InputError);
}

}  // namespace
}  // namespace hv::explore
