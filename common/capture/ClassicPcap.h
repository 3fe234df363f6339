#pragma once

#include "common/capture/CaptureRecords.h"

namespace hermes {

/// A pcap file of version 2, with stamps of microseconds or nanoseconds, in either byte order.
class ClassicPcap : public CaptureRecords {
public:
    /// magic: the first four bytes, read already. Null, and no error: it is another format.
    static std::unique_ptr<CaptureRecords> open(std::istream &stream, const std::uint8_t *magic,
                                                std::string &error);

    Next next(CaptureRecord &record) override;
    int firstLinkType() const override { return linkType_; }
    bool canSeek() const override { return true; }

private:
    using CaptureRecords::CaptureRecords;

    int linkType_ = 0;
    bool hasMicroseconds_ = false;
    bool isOld_ = false; ///< before version 2.4 some programs wrote the two lengths the other way round
};

} // namespace hermes
