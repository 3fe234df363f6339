#pragma once

#include "common/Result.h"
#include "protocol/serial/Crc32c.h"
#include "vectorlib/graph/MappedDrive.h"

#include <QByteArray>
#include <QCborStreamWriter>

#include <chrono>
#include <cstdint>
#include <future>
#include <mutex>

namespace hermes::scanmatcher::journal {

/// What the first item of a journal says of it.
constexpr char mark[] = "hermes-journal";
constexpr int version = 1;

/// A table of a block: its name, and the numbers of a row. Poses and motions are x, y (m), heading (rad).
struct Table {
    const char *name;
    int columns;
};

/// 32 bit a number, in the sensor's frame: n, mean x, y, moments xx, xy, yy, segment x1, y1, x2, y2, sigma.
constexpr Table edges{"edges", 11}, points{"points", 2};
/// 64 bit a number; the same as an edge, after id and observations, in the map's frame.
constexpr Table known{"known", 13};
/// key, motion since that key, effort, trust, edges.
constexpr Table scans{"scans", 7};
/// scan, motion since the key before, effort, variances, tracked pose, way, doubt, points.
constexpr Table keys{"keys", 13};
/// from, to, motion, information (upper triangle), may be wrong, weight.
constexpr Table motions{"motions", 13};
/// Of the last keys, and of the last motions: those before keep theirs.
constexpr Table poses{"poses", 3}, weights{"weights", 1};
/// Motion since the last key, way, turned, variances, doubt.
constexpr Table since{"since", 8};
/// Loops tried, closed, whether any was found and is news since the last correction, keys then.
constexpr Table progress{"progress", 5};

/// Of typed arrays with the least byte first (RFC 8746), and of CBOR itself (RFC 8949).
constexpr std::uint64_t floats = 85, doubles = 86, cbor = 55799;

/// What a journal is a row of: an array of a check sum and the content. The first one begins the file.
inline QByteArray item(const QByteArray &content, bool isFirst = false) {
    QByteArray bytes;
    QCborStreamWriter out(&bytes);
    if (isFirst)
        out.append(QCborTag(cbor));
    out.startArray(2);
    out.append(quint64(crc32c(content.constData(), std::size_t(content.size()))));
    out.append(content);
    out.endArray();
    return bytes;
}

} // namespace hermes::scanmatcher::journal

namespace hermes::scanmatcher {

/// Largest journal that is written and read.
constexpr qint64 largestJournal = 256 << 20;

/// What a journal tells of a drive.
struct RememberedDrive {
    vectorlib::MappedDrive drive;
    std::vector<double> trust; ///< of each scan, 0 to 1
    qint64 leftOut = 0;        ///< bytes at the end of the file, which are damaged or cut
};

/// Reads what a DriveJournal wrote, as far as it is whole; path is told in errors. InputOutput with data.path
/// where no scan can be read.
Result<RememberedDrive> readDriveJournal(const QByteArray &bytes, const QString &path);

struct JournalState {
    QString path;      ///< empty: there is none yet
    qint64 bytes = 0;  ///< on the disk
    quint64 scans = 0; ///< in it
    QString fault;     ///< why the last write failed; empty: it did not
};

/// Appends what a drive remembers to a file, so that little is lost when the program ends at once. Each drive
/// has a file of its own, made with its first scans; one that exists is never written to: NAME.journal,
/// NAME-2.journal and so on.
///
/// The file is a sequence of CBOR items (RFC 8742), each an array of the CRC-32C of its content and the
/// content, a byte string that holds a map of tables: typed arrays (RFC 8746), row by row. The first one is
/// tagged as CBOR and tells the version.
class DriveJournal {
public:
    /// Without a name nothing is written.
    DriveJournal(QString folder, QString name)
        : file_(std::move(folder), std::move(name)) {}
    /// Waits for the disk.
    ~DriveJournal() {
        settle();
        file_.close();
    }

    // In one thread:

    /// Another drive begins.
    void begin();
    /// All poses are others.
    void corrected() { isCorrected_ = true; }
    /// Brings what is new to the disk, in a thread of its own, every few seconds: does nothing between, nor
    /// while that thread still writes.
    void write(const vectorlib::MappedDrive &drive, const std::vector<double> &trust);
    /// Brings all of it to the disk, and waits for it.
    void finish(const vectorlib::MappedDrive &drive, const std::vector<double> &trust);

    // In any thread:

    JournalState state() const;

private:
    using Clock = std::chrono::steady_clock;
    /// How far a drive is written.
    struct Mark {
        std::size_t scans = 0, keys = 0, motions = 0;
        bool isBegun = false;
    };
    /// Used by one thread at a time.
    struct File {
        File(QString folder_, QString name_)
            : folder(std::move(folder_))
            , name(std::move(name_)) {}
        QString folder, name, path;
        int number = -1; // the descriptor
        qint64 size = 0;

        // False: what is in it is no longer of use, a new one has to be begun.
        bool append(const QByteArray &bytes, QString &fault);
        bool open(QString &fault);
        void close();
    };
    struct Written {
        bool isUsable = true;
        QString fault;
    };

    bool hasNews(const vectorlib::MappedDrive &drive) const;
    void start(const vectorlib::MappedDrive &drive, const std::vector<double> &trust);
    QByteArray encode(const vectorlib::MappedDrive &drive, const std::vector<double> &trust,
                      Mark &mark) const;
    static QByteArray block(const vectorlib::MappedDrive &drive, const std::vector<double> &trust, Mark &mark,
                            std::size_t scans, bool isWhole);
    void settle();

    File file_;
    Mark mark_, underWay_;                               // on the disk, and once the write is done
    bool isCorrected_ = false, writesCorrected_ = false; // since the last write, and in that under way
    Clock::time_point last_ = Clock::now();
    std::future<Written> writing_;

    mutable std::mutex mutex_;
    JournalState state_;
};

} // namespace hermes::scanmatcher
