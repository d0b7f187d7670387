#include "keyframe_numbering.h"

namespace hv::loop {

KeyframeNumbering::Verdict KeyframeNumbering::Renumber(Keyframe& keyframe) {
  const Number number{keyframe.id, keyframe.segment, keyframe.stamp};
  Verdict verdict = Verdict::kNext;
  if (last_ && number.id == last_->id && number.stamp == last_->stamp) return Verdict::kRepeated;
  if (last_ && number.id <= last_->id) {
    verdict = Verdict::kRestarted;
    start_.keyframe += last_->id + 1;
    start_.segment += last_->segment + 1;
  } else if (last_) {
    missing_ += number.id - last_->id - 1;
  }
  last_ = number;
  keyframe.id += start_.keyframe;
  keyframe.segment += start_.segment;
  return verdict;
}

}  // namespace hv::loop
