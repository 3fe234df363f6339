#include "common/daemon/Batch.h"

#include "common/Turns.h"

#include <algorithm>

namespace hermes {

Batch::~Batch() {
    inBackground([large = std::move(messages)] {}); // to free it may take long
}

void Batch::answer(int i, const QByteArray &frame) {
    --missing;
    bytes += frame.size();
    if (!isTooLarge())
        frames[size_t(i)] = frame;
    else if (!frames.empty())
        frames = {};
}

std::vector<QByteArray> Batch::take(const Codec &codec) {
    frames.erase(
        std::remove_if(frames.begin(), frames.end(), [](const QByteArray &f) { return f.isEmpty(); }),
        frames.end());
    if (!frames.empty())
        codec.joinBatch(frames);
    return std::move(frames);
}

} // namespace hermes
