#include "common/capture/PcapReader.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace hermes {

namespace {

/// The last stamp of classic pcap. pcapng has room for others, which do not fit into nanoseconds, and for
/// negative ones.
constexpr std::int64_t latest_s = (std::int64_t(1) << 32) - 1;
constexpr std::int64_t second_ns = 1000000000;

} // namespace

PcapReader::Counts &PcapReader::Counts::operator+=(const Counts &more) {
    for (auto count : {&Counts::records, &Counts::datagrams, &Counts::notUdp, &Counts::fragments,
                       &Counts::unknownLinks, &Counts::cut})
        this->*count += more.*count;
    return *this;
}

std::string PcapReader::Counts::leftOut(bool isAll) const {
    std::string text;
    const auto add = [&text](std::uint64_t count, const char *what) {
        if (count > 0)
            text += (text.empty() ? "" : ", ") + std::to_string(count) + what;
    };
    add(cut, " cut to their beginning (tcpdump -s 0 keeps them whole)");
    add(fragments, " fragments of datagrams");
    add(unknownLinks, " of a link type that is not read");
    add(isAll ? notUdp : 0, " of other protocols than UDP over IPv4");
    return text.empty() ? text : "of " + std::to_string(records) + " records were left out: " + text;
}

PcapReader::PcapReader() = default;
PcapReader::~PcapReader() = default;

Outcome<void> PcapReader::open(const std::string &path) {
    close();
    path_ = path;
    const auto name = std::filesystem::u8path(path);
    std::error_code none;
    if (std::filesystem::exists(name, none) && !std::filesystem::is_regular_file(name, none))
        return error_ = path + ": not a regular file"; // to open a pipe would wait
    auto file = std::make_unique<std::ifstream>(name, std::ios::binary);
    if (!*file)
        return error_ = path + ": cannot be opened: " + std::strerror(errno);
    const Outcome<void> opened = open(*file, path);
    if (opened)
        file_ = std::move(file);
    return opened;
}

Outcome<void> PcapReader::open(std::istream &stream, const std::string &name) {
    close();
    path_ = name;
    error_.clear();
    counts_ = Counts();
    std::string why;
    records_ = CaptureRecords::open(stream, why);
    if (!records_)
        return error_ = name + ": not a capture that can be read, pcap or pcapng expected: " + why;
    canSeek_ = records_->canSeek();
    const std::vector<int> &links = records_->linkTypes();
    if (std::none_of(links.begin(), links.end(), isKnownLinkType)) {
        error_ = name + ": link type " + std::to_string(links.front()) + " is not read; read are " +
                 knownLinkTypes();
        close();
        return error_;
    }
    return {};
}

PcapReader::Next PcapReader::next(Datagram &datagram) {
    if (!records_)
        return error_.empty() ? Next::End : Next::Failed;
    for (;;) {
        const CaptureRecords::Next result = records_->next(record_);
        if (result == CaptureRecords::Next::End) {
            close();
            return Next::End;
        }
        if (result == CaptureRecords::Next::Failed)
            return fail(records_->offset(), "cannot be read, the " + std::to_string(counts_.records) +
                                                " before it are whole: " + records_->error());
        if (std::abs(record_.seconds) > latest_s)
            return fail(record_.offset, "has a stamp of " + std::to_string(record_.seconds) +
                                            " s since 1970, at most " + std::to_string(latest_s) +
                                            " expected");
        ++counts_.records;
        if (!isKnownLinkType(record_.linkType)) {
            ++counts_.unknownLinks;
            continue;
        }
        const FrameFault fault =
            parseFrame(LinkType(record_.linkType), record_.frame.data(), record_.frame.size(), datagram);
        counts_.notUdp += fault == FrameFault::NotUdp;
        counts_.fragments += fault == FrameFault::Fragment;
        counts_.cut += fault == FrameFault::Short;
        if (fault != FrameFault::None)
            continue;
        ++counts_.datagrams;
        datagram.stamp_ns = record_.seconds * second_ns + record_.nanoseconds;
        return Next::Datagram;
    }
}

PcapReader::Next PcapReader::fail(std::int64_t offset, const std::string &what) {
    error_ = path_ + ": record " + std::to_string(counts_.records + 1) + " at byte " +
             std::to_string(offset) + ' ' + what;
    close();
    return Next::Failed;
}

Outcome<void> PcapReader::seek(const Place &place) {
    if (place.offset == 0)
        return open(std::string(path_));
    if ((!records_ && !open(std::string(path_))) || !canSeek_ || !records_->seek(place.offset)) {
        if (error_.empty())
            error_ = path_ + ": cannot be read from byte " + std::to_string(place.offset) + " on";
        close();
        return error_;
    }
    counts_.records = place.records;
    return {};
}

} // namespace hermes
