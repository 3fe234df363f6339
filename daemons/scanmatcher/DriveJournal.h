#pragma once

#include "common/Result.h"
#include "common/files/AppendFile.h"
#include "daemons/scanmatcher/JournalBlock.h"
#include "vectorlib/graph/MappedDrive.h"

#include <QByteArray>

#include <chrono>
#include <future>
#include <mutex>

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
    ~DriveJournal() { settle(); }

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
    struct Written {
        bool isUsable = true; // else a new file has to be begun
        QString fault;
    };
    /// Used by one thread at a time.
    struct File : AppendFile {
        File(QString folder_, QString name_)
            : folder(std::move(folder_))
            , name(std::move(name_)) {}
        QString folder, name;

        Written write(const QByteArray &bytes);
        // Gives what is wrong; empty: nothing.
        QString begin();
    };

    bool hasNews(const vectorlib::MappedDrive &drive) const;
    void start(const vectorlib::MappedDrive &drive, const std::vector<double> &trust);
    QByteArray encode(const vectorlib::MappedDrive &drive, const std::vector<double> &trust,
                      Mark &mark) const;
    static journal::Block block(const vectorlib::MappedDrive &drive, const std::vector<double> &trust,
                                Mark &mark, std::size_t scans, bool isWhole);
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
