#pragma once

#include "common/Outcome.h"
#include "common/capture/CaptureRecords.h"
#include "common/capture/Frame.h"

#include <istream>
#include <memory>
#include <string>

namespace hermes {

/// Reads the UDP datagrams of a capture file, pcap or pcapng. After an error the datagrams before it have all
/// been delivered and the message names the file, the record and the byte where it begins.
class PcapReader {
public:
    enum class Next { Datagram, End, Failed };
    /// Records that gave no datagram, by reason; and those that did.
    struct Counts {
        std::uint64_t records = 0;
        std::uint64_t datagrams = 0;
        std::uint64_t notUdp = 0;
        std::uint64_t fragments = 0;
        std::uint64_t unknownLinks = 0; ///< of an interface whose link type is not read
        std::uint64_t cut = 0;          ///< shorter than its own lengths say

        Counts &operator+=(const Counts &more);
        /// For people, what of UDP was left out, and how to have it; empty: nothing. isAll: also other
        /// protocols.
        std::string leftOut(bool isAll = false) const;
    };

    /// Where a record begins.
    struct Place {
        std::int64_t offset = 0;   ///< in the file, bytes; 0: its beginning
        std::uint64_t records = 0; ///< before it
    };

    PcapReader();
    ~PcapReader();
    PcapReader(const PcapReader &) = delete;
    PcapReader &operator=(const PcapReader &) = delete;

    /// A regular file.
    Outcome<void> open(const std::string &path);
    /// From a stream that lives as long; name is what messages call it.
    Outcome<void> open(std::istream &stream, const std::string &name);
    /// The payload stays valid until the next call.
    Next next(Datagram &datagram);
    void close() {
        records_.reset();
        file_.reset();
    }

    /// Of the next record.
    Place place() const { return {records_ ? records_->offset() : 0, counts_.records}; }
    /// Only classic pcap can be read from a place in the middle; a pcapng tells on the way what to know.
    bool canSeek() const { return canSeek_; }
    /// Goes on at a place that a reader of the same file told. To the beginning, or after the end, it opens
    /// path() again: not for what was opened as a stream.
    Outcome<void> seek(const Place &place);

    const std::string &path() const { return path_; }
    const std::string &error() const { return error_; } ///< after Next::Failed, or what could not be opened
    const Counts &counts() const { return counts_; }

private:
    Next fail(std::int64_t offset, const std::string &what);

    std::string path_;
    std::string error_;
    Counts counts_;
    bool canSeek_ = false;
    std::unique_ptr<std::istream> file_;
    std::unique_ptr<CaptureRecords> records_;
    CaptureRecord record_;
};

} // namespace hermes
