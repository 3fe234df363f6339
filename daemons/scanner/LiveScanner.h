#pragma once

#include "common/ports/PortThread.h"
#include "daemons/scanner/ScanReader.h"

#include <QObject>
#include <QTimer>
#include <atomic>
#include <memory>

namespace hermes::scanner {

/// The scanner on a line: asks it what has to be asked, and finds which one it is where nobody has told. Of
/// the main thread.
class LiveScanner : public QObject {
public:
    /// url: of the line, the baud rate only where it is not that of the model. model: null: whichever
    /// answers. recording: gets all bytes that come in. note: of the line, once it is known which scanner it
    /// is.
    LiveScanner(const QString &url, const scan::ScannerModel *model, ChunkQueue &recording,
                scan::RevolutionAssembler::Sink sink, PortThread::Note note);
    ~LiveScanner() override;

    void start();
    void stop();

    /// The one that is read or tried now.
    const ScanReader &reader() const { return *reader_; }
    /// It measures, or it has told who it is and that it cannot.
    bool isFound() const { return isFound_; }
    /// Which it is; null: not known, or of those that speak alike it may be any.
    const scan::ScannerModel *model() const;
    /// Which were tried in vain, if that were all.
    const QStringList &inVain() const { return inVain_; }
    PortThread::State port() const { return port_->state(); }
    QString url() const { return url_; } ///< with the baud rate

private:
    void open(const scan::ScannerModel &model);
    void tryNext();
    void filled();
    void step();
    void act(const scan::HostAction &action);

    const QString address_;
    ChunkQueue &recording_;
    const scan::RevolutionAssembler::Sink sink_;
    const PortThread::Note note_;
    const scan::ScannerModel *const told_; ///< null: it is looked for
    std::vector<const scan::ScannerModel *> candidates_;
    std::size_t candidate_ = 0;
    QString url_;
    std::unique_ptr<ScanReader> reader_;
    std::unique_ptr<PortThread> port_;
    QTimer timer_;
    std::atomic<bool> isFound_{false};
    double openedMono_ = 0; ///< the line was, for this one; 0: it is not open
    QStringList tried_, inVain_;
};

} // namespace hermes::scanner
