#include "common/capture/PcapReader.h"

#include "common/capture/Frame.h"

#include <pcap/pcap.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace hermes {

PcapReader::PcapReader()
    : m_pcap(nullptr, &pcap_close) {}

PcapReader::~PcapReader() = default;

bool PcapReader::open(const std::string &path) {
    close();
    m_path = path;
    m_error.clear();
    m_counts = Counts();
    std::FILE *file = std::fopen(path.c_str(), "rb");
    if (!file) {
        m_error = path + ": cannot be opened: " + std::strerror(errno);
        return false;
    }
    char message[PCAP_ERRBUF_SIZE] = "";
    m_pcap.reset(pcap_fopen_offline_with_tstamp_precision(file, PCAP_TSTAMP_PRECISION_NANO, message));
    if (!m_pcap) {
        std::fclose(file);
        m_error = path + ": not a capture that can be read, pcap or pcapng expected: " + message;
        return false;
    }
    m_linkType = pcap_datalink(m_pcap.get());
    if (!isKnownLinkType(m_linkType)) {
        const char *name = pcap_datalink_val_to_name(m_linkType);
        m_error = path + ": link type " + std::to_string(m_linkType) +
                  (name ? std::string(" (") + name + ")" : "") +
                  " is not supported, Ethernet, raw IPv4, Linux cooked or BSD loopback expected";
        close();
        return false;
    }
    return true;
}

PcapReader::Next PcapReader::next(Datagram &datagram) {
    if (!m_pcap)
        return m_error.empty() ? Next::End : Next::Failed;
    for (;;) {
        const long begin = std::ftell(pcap_file(m_pcap.get()));
        pcap_pkthdr *header = nullptr;
        const u_char *frame = nullptr;
        const int result = pcap_next_ex(m_pcap.get(), &header, &frame);
        if (result == PCAP_ERROR_BREAK) {
            close();
            return Next::End;
        }
        if (result != 1) {
            m_error = m_path + ": record " + std::to_string(m_counts.records + 1) + " at byte " +
                      std::to_string(begin) + " cannot be read, the " + std::to_string(m_counts.records) +
                      " before it are whole: " + pcap_geterr(m_pcap.get());
            close();
            return Next::Failed;
        }
        ++m_counts.records;
        const FrameFault fault = parseFrame(LinkType(m_linkType), frame, header->caplen, datagram);
        m_counts.notUdp += fault == FrameFault::NotUdp;
        m_counts.fragments += fault == FrameFault::Fragment;
        m_counts.cut += fault == FrameFault::Short;
        if (fault != FrameFault::None)
            continue;
        ++m_counts.datagrams;
        datagram.stamp_ns =
            std::int64_t(header->ts.tv_sec) * 1000000000 + header->ts.tv_usec; // ns, as asked for
        return Next::Datagram;
    }
}

void PcapReader::close() {
    m_pcap.reset();
}

} // namespace hermes
