// The records of capture files, beside libpcap: files of all kinds, made at random.
#include "tests/common/CaptureFiles.h"

#include <pcap/pcap.h>

using namespace hermes;
using namespace hermes::captures;

static Reading theirs(const QByteArray &content, const QString &path) {
    const bool isPcapng = content.startsWith(QByteArray::fromHex("0a0d0d0a"));
    put(path, content);
    char why[PCAP_ERRBUF_SIZE] = "";
    pcap_t *const pcap = pcap_open_offline_with_tstamp_precision(path.toLocal8Bit().constData(),
                                                                 PCAP_TSTAMP_PRECISION_NANO, why);
    Reading reading;
    reading.isOpened = pcap != nullptr;
    if (!pcap)
        return reading;
    pcap_pkthdr *header = nullptr;
    const u_char *frame = nullptr;
    int result = 0;
    while ((result = pcap_next_ex(pcap, &header, &frame)) == 1)
        // Stamps of classic pcap have no sign here; in libpcap those of this byte order do.
        reading.records.push_back({isPcapng ? qint64(header->ts.tv_sec) : quint32(header->ts.tv_sec),
                                   qint64(header->ts.tv_usec),
                                   QByteArray(reinterpret_cast<const char *>(frame), int(header->caplen))});
    reading.failed = result != PCAP_ERROR_BREAK;
    pcap_close(pcap);
    return reading;
}

class TestCaptureRecords : public QObject {
    Q_OBJECT

private Q_SLOTS:
    void readsWhatLibpcapReads() {
        const unsigned seed = std::random_device()();
        Generator generator(seed);
        QTemporaryDir folder;
        std::size_t records = 0;
        for (int round = 0; round < 2000; ++round) {
            const QByteArray content = round % 2 ? generator.pcapng() : generator.classic();
            const Reading here = ours(content), there = theirs(content, folder.filePath("c.pcap"));
            const QByteArray what = "seed " + QByteArray::number(seed) + ", round " +
                                    QByteArray::number(round) + ": " + content.toHex();
            QVERIFY2(there.isOpened && !there.failed, what);
            QVERIFY2(here.isOpened && !here.failed && here.records == there.records, what);
            records += here.records.size();
        }
        QVERIFY(records > 2000);
    }
};
