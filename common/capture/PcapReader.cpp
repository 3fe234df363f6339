#include "common/capture/PcapReader.h"

#include "common/capture/Frame.h"

#include <pcap/pcap.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace hermes {

namespace {

/// What 32 bits can hold, signed or not: the stamps of classic pcap.
constexpr std::int64_t earliest_s = -(std::int64_t(1) << 31), latest_s = (std::int64_t(1) << 32) - 1;

bool isPcapng(std::FILE *file) {
    constexpr unsigned char magic[4] = {0x0A, 0x0D, 0x0D, 0x0A};
    unsigned char begin[4] = {};
    const std::size_t size = std::fread(begin, 1, sizeof begin, file);
    std::rewind(file);
    return size == sizeof begin && std::memcmp(begin, magic, sizeof magic) == 0;
}

} // namespace

PcapReader::PcapReader()
    : pcap_(nullptr, &pcap_close) {}

PcapReader::~PcapReader() = default;

Outcome<void> PcapReader::open(const std::string &path) {
    close();
    path_ = path;
    error_.clear();
    counts_ = Counts();
    std::FILE *file = std::fopen(path.c_str(), "rb");
    if (!file) {
        error_ = path + ": cannot be opened: " + std::strerror(errno);
        return error_;
    }
    canSeek_ = !isPcapng(file);
    char message[PCAP_ERRBUF_SIZE] = "";
    pcap_.reset(pcap_fopen_offline_with_tstamp_precision(file, PCAP_TSTAMP_PRECISION_NANO, message));
    if (!pcap_) {
        std::fclose(file);
        error_ = path + ": not a capture that can be read, pcap or pcapng expected: " + message;
        return error_;
    }
    linkType_ = pcap_datalink(pcap_.get());
    if (!isKnownLinkType(linkType_)) {
        const char *name = pcap_datalink_val_to_name(linkType_);
        error_ = path + ": link type " + std::to_string(linkType_) +
                 (name ? std::string(" (") + name + ")" : "") + " is not read; read are " + knownLinkTypes();
        close();
        return error_;
    }
    return {};
}

PcapReader::Next PcapReader::next(Datagram &datagram) {
    if (!pcap_)
        return error_.empty() ? Next::End : Next::Failed;
    for (;;) {
        const std::int64_t begin = ::ftello(pcap_file(pcap_.get()));
        pcap_pkthdr *header = nullptr;
        const u_char *frame = nullptr;
        const int result = pcap_next_ex(pcap_.get(), &header, &frame);
        if (result == PCAP_ERROR_BREAK) {
            close();
            return Next::End;
        }
        if (result != 1) {
            error_ = path_ + ": record " + std::to_string(counts_.records + 1) + " at byte " +
                     std::to_string(begin) + " cannot be read, the " + std::to_string(counts_.records) +
                     " before it are whole: " + pcap_geterr(pcap_.get());
            close();
            return Next::Failed;
        }
        // pcapng has room for stamps that do not fit into nanoseconds.
        if (header->ts.tv_sec < earliest_s || header->ts.tv_sec > latest_s) {
            error_ = path_ + ": record " + std::to_string(counts_.records + 1) + " at byte " +
                     std::to_string(begin) + " has a stamp of " + std::to_string(header->ts.tv_sec) +
                     " s since 1970, at most " + std::to_string(latest_s) + " expected";
            close();
            return Next::Failed;
        }
        ++counts_.records;
        const FrameFault fault = parseFrame(LinkType(linkType_), frame, header->caplen, datagram);
        counts_.notUdp += fault == FrameFault::NotUdp;
        counts_.fragments += fault == FrameFault::Fragment;
        counts_.cut += fault == FrameFault::Short;
        if (fault != FrameFault::None)
            continue;
        ++counts_.datagrams;
        datagram.stamp_ns =
            std::int64_t(header->ts.tv_sec) * 1000000000 + header->ts.tv_usec; // ns, as asked for
        return Next::Datagram;
    }
}

PcapReader::Place PcapReader::place() const {
    return {pcap_ ? ::ftello(pcap_file(pcap_.get())) : 0, counts_.records};
}

Outcome<void> PcapReader::seek(const Place &place) {
    if (place.offset == 0)
        return open(std::string(path_));
    if ((!pcap_ && !open(std::string(path_))) || !canSeek_ ||
        ::fseeko(pcap_file(pcap_.get()), off_t(place.offset), SEEK_SET) != 0) {
        if (error_.empty())
            error_ = path_ + ": cannot be read from byte " + std::to_string(place.offset) + " on";
        close();
        return error_;
    }
    counts_.records = place.records;
    return {};
}

void PcapReader::close() {
    pcap_.reset();
}

} // namespace hermes
