#include "hv_relocalize_ndt/relocalize_config.h"

namespace hv::relocalize {

void AcceptanceConfig::Describe(ConfigVisitor& visitor) {
  visitor.Field("min_fit", min_fit,
                "share of the scan's surfaces that must fit near a guess, 0 to 1");
  visitor.Field(
      "min_fit_anywhere", min_fit_anywhere,
      "the same without a guess: the other end of a symmetric hall, of which the map knows "
      "only a part, fits by some 80 %");
  visitor.Field("min_overlap", min_overlap,
                "share of them that must lie where the map knows anything, 0 to 1");
  visitor.Field("max_seen_through", max_seen_through,
                "share of the map in view that the scan may pass through, 0 to 1");
  visitor.Field("min_lead", min_lead,
                "lead of the best place over any other, in standard deviations of chance");
}

void AcceptanceConfig::Validate(ConfigProblems& problems) const {
  const auto share = [&](double value, const char* key) {
    problems.Require(value >= 0.0 && value <= 1.0, std::string("accept.") + key,
                     "must lie between 0 and 1");
  };
  share(min_fit, "min_fit");
  share(min_fit_anywhere, "min_fit_anywhere");
  share(min_overlap, "min_overlap");
  share(max_seen_through, "max_seen_through");
  problems.Require(min_lead >= 0.0, "accept.min_lead", "must not be negative");
}

void RelocalizeConfig::Describe(ConfigVisitor& visitor) {
  visitor.Section("ndt", ndt, "alignment at several resolutions");
  visitor.Section("search", search, "search over the structure of the map");
  visitor.Section("score", score, "how the fit of a place is measured");
  visitor.Section("accept", accept, "when a place counts as found");
  visitor.Field("descriptor_candidates", descriptor_candidates,
                "places proposed by the descriptors of the map");
  visitor.Field("guess_radius_m", guess_radius_m, "how far a guess may be off [m]");
  visitor.Field("guess_heading_deg", guess_heading_deg, "and how far its heading [deg]");
  visitor.Field("covariance_scale", covariance_scale,
                "neighbouring points err alike: factor on the covariance of the alignment");
}

void RelocalizeConfig::Validate(ConfigProblems& problems) const {
  ndt.Validate(problems);
  search.Validate(problems);
  score.Validate(problems);
  accept.Validate(problems);
  problems.Require(descriptor_candidates >= 0, "localization.descriptor_candidates",
                   "must not be negative");
  problems.Require(guess_radius_m > 0.0, "localization.guess_radius_m", "must be positive");
  problems.Require(guess_heading_deg > 0.0, "localization.guess_heading_deg", "must be positive");
  problems.Require(covariance_scale > 0.0, "localization.covariance_scale", "must be positive");
}

}  // namespace hv::relocalize
