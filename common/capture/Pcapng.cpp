#include "common/capture/Pcapng.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

namespace hermes {

namespace {

// https://www.ietf.org/archive/id/draft-ietf-opsawg-pcapng-02.html
enum BlockType : std::uint32_t {
    sectionHeader = 0x0A0D0D0A, // the same in both byte orders
    interfaceDescription = 1,
    oldPacket = 2,
    simplePacket = 3,
    enhancedPacket = 6,
};
constexpr unsigned optionEnd = 0, optionResolution = 9, optionOffset = 14;
constexpr std::uint8_t bigEndianMark[4] = {0x1A, 0x2B, 0x3C, 0x4D};
constexpr std::uint8_t littleEndianMark[4] = {0x4D, 0x3C, 0x2B, 0x1A};
constexpr std::uint32_t aroundBody = 12; // type, length, and the length again
constexpr std::uint32_t longestBlock = 16 << 20;
constexpr std::uint64_t second_ns = 1000000000;
const char *const noInterface = "a frame comes before any interface is described";

std::string tooLong(std::size_t length, std::size_t most) {
    return "found a frame of " + std::to_string(length) + " bytes where at most " + std::to_string(most) +
           " can be";
}

} // namespace

std::unique_ptr<CaptureRecords> Pcapng::open(std::istream &stream, const std::uint8_t *magic,
                                             std::string &error) {
    std::unique_ptr<Pcapng> file(new Pcapng(stream));
    error = "its first bytes are those of neither";
    if (file->word(magic) != sectionHeader)
        return nullptr;
    Block &block = file->block_;
    block.type = sectionHeader;
    std::uint8_t length[4];
    const bool fine = file->read(length, sizeof length, "a block's length") &&
                      file->readRest(block, length) == Next::Record && file->beginSection(block);
    if (fine)
        file->first_ = file->toFrame();
    if (!file->linkTypes_.empty()) { // what came after them is told by next()
        error.clear();
        return file;
    }
    if (file->first_ == Next::End)
        file->error_ = "it describes no interface";
    error = file->first_ == Next::Record ? noInterface : file->error_;
    return nullptr;
}

CaptureRecords::Next Pcapng::next(CaptureRecord &record) {
    const Next found = first_ ? *std::exchange(first_, std::nullopt) : toFrame();
    if (found != Next::Record)
        return found;
    record.offset = offset_;
    const Next taken =
        block_.type == simplePacket ? takeSimpleFrame(block_, record) : takeFrame(block_, record);
    if (taken == Next::Record)
        offset_ = nextOffset_;
    return taken;
}

/// Up to the next block that has a frame.
CaptureRecords::Next Pcapng::toFrame() {
    for (;;) {
        offset_ = nextOffset_;
        const Next read = readBlock(block_);
        if (read != Next::Record)
            return read;
        if (block_.type == interfaceDescription && !addInterface(block_))
            return Next::Failed;
        if (hasFrame(block_))
            return Next::Record;
    }
}

bool Pcapng::hasFrame(const Block &block) {
    return block.type == enhancedPacket || block.type == oldPacket || block.type == simplePacket;
}

CaptureRecords::Next Pcapng::readBlock(Block &block) {
    std::uint8_t begin[8];
    bool atEnd = false;
    if (!read(begin, sizeof begin, "a block's header", atEnd))
        return atEnd ? Next::End : Next::Failed;
    block.type = word(begin);
    const Next next = readRest(block, begin + 4);
    if (next == Next::Record && block.type == sectionHeader && !beginSection(block))
        return Next::Failed;
    return next;
}

CaptureRecords::Next Pcapng::readRest(Block &block, const std::uint8_t *lengthBytes) {
    std::uint8_t mark[4];
    std::size_t done = 0;
    if (block.type == sectionHeader) { // tells the byte order of its own length
        if (!read(mark, sizeof mark, "the mark of the byte order"))
            return Next::Failed;
        bigEndian_ = std::memcmp(mark, bigEndianMark, sizeof mark) == 0;
        if (!bigEndian_ && std::memcmp(mark, littleEndianMark, sizeof mark) != 0)
            return fail("found no mark of the byte order where a section begins");
        done = sizeof mark;
    }
    const std::uint32_t length = word(lengthBytes);
    if (length < aroundBody + done || length % 4 != 0 || length > longestBlock)
        return fail("found a block of " + std::to_string(length) +
                    " bytes, expected a multiple of 4 from 12 to " + std::to_string(longestBlock));
    block.body.resize(length - aroundBody);
    std::copy_n(mark, done, block.body.begin());
    std::uint8_t again[4];
    if (!read(block.body.data() + done, block.body.size() - done, "a block") ||
        !read(again, sizeof again, "a block's second length"))
        return Next::Failed;
    if (word(again) != length)
        return fail("found two lengths of a block, " + std::to_string(length) + " and " +
                    std::to_string(word(again)) + ", expected them to be the same");
    nextOffset_ += length;
    return Next::Record;
}

bool Pcapng::beginSection(const Block &block) {
    interfaces_.clear();
    if (block.body.size() < 16)
        return refuse("found a section's header of " + std::to_string(block.body.size()) +
                      " bytes, expected 16");
    const int version = half(block.body.data() + 4), part = half(block.body.data() + 6);
    if (version == 1)
        return true;
    return refuse("version " + std::to_string(version) + '.' + std::to_string(part) + ", expected 1.0");
}

bool Pcapng::addInterface(const Block &block) {
    if (block.body.size() < 8)
        return refuse("found an interface's description of " + std::to_string(block.body.size()) +
                      " bytes, expected 8");
    Interface interface;
    interface.linkType = half(block.body.data());
    interface.longest = longestFrame(word(block.body.data() + 4));
    for (std::size_t at = 8; at + 4 <= block.body.size();) {
        const unsigned code = half(block.body.data() + at), size = half(block.body.data() + at + 2);
        at += 4;
        if (code == optionEnd)
            break;
        if (size > block.body.size() - at)
            return refuse("an option of an interface is longer than its block");
        if (!readOption(interface, code, block.body.data() + at, size))
            return false;
        at += (size + 3) / 4 * 4;
    }
    interfaces_.push_back(interface);
    linkTypes_.push_back(interface.linkType);
    return true;
}

bool Pcapng::readOption(Interface &interface, unsigned code, const std::uint8_t *value, unsigned size) {
    if (code == optionResolution && size == 1) {
        interface.ofTwo = (value[0] & 0x80) != 0;
        interface.exponent = value[0] & 0x7F;
        if (interface.exponent > (interface.ofTwo ? 63 : 19))
            return refuse("the clock of an interface has steps of " +
                          std::string(interface.ofTwo ? "2" : "10") + " to the power of -" +
                          std::to_string(interface.exponent) + " s");
    }
    if (code == optionOffset && size == 8) {
        const std::uint64_t first = word(value), second = word(value + 4);
        interface.offset_s = std::int64_t(bigEndian_ ? first << 32 | second : second << 32 | first);
    }
    return true;
}

CaptureRecords::Next Pcapng::takeFrame(const Block &block, CaptureRecord &record) {
    constexpr std::size_t header = 20;
    if (block.body.size() < header)
        return fail("found a packet's block of " + std::to_string(block.body.size()) +
                    " bytes, expected at least " + std::to_string(header));
    const std::uint8_t *body = block.body.data();
    const std::uint32_t number = block.type == oldPacket ? half(body) : word(body);
    if (number >= interfaces_.size())
        return fail("found a frame of interface " + std::to_string(number) +
                    ", of those that are described " + std::to_string(interfaces_.size()));
    const std::uint32_t length = word(body + 12);
    const std::size_t most = std::min<std::size_t>(interfaces_[number].longest, block.body.size() - header);
    if (length > most)
        return fail(tooLong(length, most));
    record.linkType = interfaces_[number].linkType;
    setStamp(interfaces_[number], std::uint64_t(word(body + 4)) << 32 | word(body + 8), record);
    record.frame.assign(body + header, body + header + length);
    return Next::Record;
}

CaptureRecords::Next Pcapng::takeSimpleFrame(const Block &block, CaptureRecord &record) {
    if (block.body.size() < 4 || interfaces_.empty())
        return fail(interfaces_.empty() ? noInterface : "found a packet's block without a length");
    const std::uint32_t length = std::min(word(block.body.data()), interfaces_.front().longest);
    if (length > block.body.size() - 4)
        return fail(tooLong(length, block.body.size() - 4));
    record.linkType = interfaces_.front().linkType;
    setStamp(interfaces_.front(), 0, record);
    record.frame.assign(block.body.data() + 4, block.body.data() + 4 + length);
    return Next::Record;
}

void Pcapng::setStamp(const Interface &interface, std::uint64_t ticks, CaptureRecord &record) const {
    std::uint64_t whole = 0, part_ns = 0;
    if (interface.ofTwo) {
        const unsigned bits = interface.exponent;
        whole = ticks >> bits;
        const std::uint64_t part = ticks - (whole << bits);
        const unsigned kept = std::min(bits, 34u); // 2^34 and 10^9 have a product below 2^64
        part_ns = (part >> (bits - kept)) * second_ns >> kept;
    } else {
        std::uint64_t units = 1;
        for (unsigned i = 0; i < interface.exponent; ++i)
            units *= 10;
        whole = ticks / units;
        const std::uint64_t part = ticks % units;
        part_ns = units <= second_ns ? part * (second_ns / units) : part / (units / second_ns);
    }
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max() / 2;
    record.seconds =
        std::int64_t(std::min(whole, std::uint64_t(most))) + std::clamp(interface.offset_s, -most, most);
    record.nanoseconds = std::int64_t(part_ns);
}

} // namespace hermes
