#include "common/daemon/Batch.h"

#include "common/Turns.h"

#include <algorithm>

namespace hermes {

Batch::~Batch() {
    inBackground([large = std::move(messages_)] {}); // to free it may take long
}

void Batch::answer(int i, const QByteArray &frame) {
    --missing_;
    bytes_ += frame.size();
    if (!isTooLarge())
        frames_[size_t(i)] = frame;
    else if (!frames_.empty())
        frames_ = {};
}

std::vector<QByteArray> Batch::take(const Codec &codec) {
    frames_.erase(
        std::remove_if(frames_.begin(), frames_.end(), [](const QByteArray &f) { return f.isEmpty(); }),
        frames_.end());
    if (!frames_.empty())
        codec.joinBatch(frames_);
    return std::move(frames_);
}

} // namespace hermes
