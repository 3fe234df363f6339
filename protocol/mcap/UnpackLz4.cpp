#include "protocol/mcap/Unpack.h"

#ifdef HERMES_LZ4
#include <lz4frame.h>
#include <memory>
#endif

namespace hermes::mcap {

#ifdef HERMES_LZ4

std::string unpackLz4(std::string_view packed, std::string &to) {
    LZ4F_dctx *context = nullptr;
    if (const auto code = LZ4F_createDecompressionContext(&context, LZ4F_VERSION); LZ4F_isError(code))
        return std::string("lz4: ") + LZ4F_getErrorName(code);
    const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx *)> kept(context,
                                                                             LZ4F_freeDecompressionContext);
    std::size_t done = 0, hint = 1; // bytes written; 0: a frame has ended
    while (!packed.empty()) {
        std::size_t written = to.size() - done, taken = packed.size();
        hint = LZ4F_decompress(context, to.data() + done, &written, packed.data(), &taken, nullptr);
        if (LZ4F_isError(hint))
            return std::string("lz4: ") + LZ4F_getErrorName(hint);
        if (written == 0 && taken == 0)
            return "lz4: it is larger than it tells";
        done += written;
        packed.remove_prefix(taken);
    }
    to.resize(done);
    return hint == 0 ? "" : "lz4: it is cut off";
}

#else

std::string unpackLz4(std::string_view, std::string &) {
    return "found bytes that lz4 has packed, expected others: this program was built without liblz4";
}

#endif

} // namespace hermes::mcap
