#pragma once

#include "common/capture/CaptureRecords.h"

namespace hermes {

/// A pcap file of version 2, with stamps of microseconds or nanoseconds, in either byte order, or a
/// "modified" one of microseconds. Frames are cut at the file's limit; those over usualLongestFrame are taken
/// for damage. Stamps have no sign: they end in 2106. (libpcap takes them for negative from 2038 on, where
/// the byte order is that of the machine.)
class ClassicPcap : public CaptureRecords {
public:
    /// magic: the first four bytes, read already. Null, and no error: it is another format.
    static std::unique_ptr<CaptureRecords> open(std::istream &stream, const std::uint8_t *magic,
                                                std::string &error);

    Next next(CaptureRecord &record) override;
    bool canSeek() const override { return true; }

private:
    using CaptureRecords::CaptureRecords;

    std::size_t recordHeaderBytes_ = 16;
    std::uint32_t longest_ = usualLongestFrame;
    bool hasMicroseconds_ = false;
    bool isOld_ = false; ///< before version 2.4 some programs wrote the two lengths the other way round
};

} // namespace hermes
