#include "protocol/bag/Bzip2.h"

#ifdef HERMES_BZIP2
#include <bzlib.h>
#endif

namespace hermes::bag {

#ifdef HERMES_BZIP2

std::string unpackBzip2(std::string_view packed, std::string &to) {
    unsigned size = unsigned(to.size());
    // The library does not write to what it reads.
    const int code = BZ2_bzBuffToBuffDecompress(to.data(), &size, const_cast<char *>(packed.data()),
                                                unsigned(packed.size()), 0, 0);
    if (code == BZ_OUTBUFF_FULL)
        return "bz2: it is larger than it tells";
    if (code != BZ_OK)
        return code == BZ_UNEXPECTED_EOF ? "bz2: it is cut off"
                                         : "bz2: the data are damaged (" + std::to_string(code) + ")";
    to.resize(size);
    return {};
}

#else

std::string unpackBzip2(std::string_view, std::string &) {
    return "found bytes that bz2 has packed, expected others: this program was built without libbz2";
}

#endif

} // namespace hermes::bag
