#pragma once

#include "common/capture/CaptureRecords.h"

#include <optional>

namespace hermes {

/// A pcapng file of version 1: its sections may have either byte order, its interfaces each a link type and a
/// clock of their own. A frame without a stamp (a simple packet block) is of the first moment that the clock
/// can tell, and cut at its interface's limit; others that are longer are taken for damage.
class Pcapng : public CaptureRecords {
public:
    /// magic: the first four bytes, read already.
    static std::unique_ptr<CaptureRecords> open(std::istream &stream, const std::uint8_t *magic,
                                                std::string &error);

    Next next(CaptureRecord &record) override;
    bool canSeek() const override { return false; } // it tells on the way what to know

private:
    struct Interface {
        int linkType = 0;
        std::uint32_t longest = usualLongestFrame;
        bool ofTwo = false; ///< ticks are a power of 1/2, otherwise of 1/10
        unsigned exponent = 6;
        std::int64_t offset_s = 0;
    };
    struct Block {
        std::uint32_t type = 0;
        std::vector<std::uint8_t> body; ///< between the lengths
    };

    using CaptureRecords::CaptureRecords;

    static bool hasFrame(const Block &block);
    Next toFrame();
    Next readBlock(Block &block);
    Next readRest(Block &block, const std::uint8_t *length);
    bool beginSection(const Block &block);
    bool addInterface(const Block &block);
    bool readOption(Interface &interface, unsigned code, const std::uint8_t *value, unsigned size);
    Next takeFrame(const Block &block, CaptureRecord &record);
    Next takeSimpleFrame(const Block &block, CaptureRecord &record);
    void setStamp(const Interface &interface, std::uint64_t ticks, CaptureRecord &record) const;

    std::vector<Interface> interfaces_; ///< of this section
    Block block_;
    std::optional<Next> first_; ///< what toFrame() gave before next() was called
    std::int64_t nextOffset_ = 0;
};

} // namespace hermes
