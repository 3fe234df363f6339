#include "daemons/scanner/LiveScanner.h"

#include "common/interface/InterfaceUrl.h"
#include "common/interface/SerialInterface.h"

#include <QElapsedTimer>
#include <future>

namespace hermes::scanner {
namespace {

constexpr int period_ms = 10, longestWork_ms = 5;
constexpr std::chrono::milliseconds farewellTimeout{100};

} // namespace

LiveScanner::LiveScanner(const QString &url, const scan::ScannerModel *model, ChunkQueue &recording,
                         scan::RevolutionAssembler::Sink sink, PortThread::Note note)
    : address_(url)
    , recording_(recording)
    , sink_(std::move(sink))
    , note_(std::move(note))
    , told_(model)
    , candidates_(model ? std::vector{model} : scan::scannerSearch(url.startsWith("serial:")))
    , isFound_(model) {
    connect(&timer_, &QTimer::timeout, this, &LiveScanner::step);
    open(*candidates_.front());
}

LiveScanner::~LiveScanner() {
    stop();
}

void LiveScanner::start() {
    reader_->queue().open();
    port_->start();
    timer_.start(period_ms);
}

void LiveScanner::stop() {
    timer_.stop();
    std::promise<void> said; // outlives the thread
    if (const std::string farewell = reader_->protocol().farewell();
        isFound_ && !farewell.empty() && port_->state().carrier == Interface::State::Open) {
        port_->with([&said, farewell](Interface &line) {
            line.write(QByteArray::fromStdString(farewell));
            line.flush();
            said.set_value();
        });
        said.get_future().wait_for(farewellTimeout);
    }
    port_->end();
}

void LiveScanner::open(const scan::ScannerModel &model) {
    port_.reset();
    reader_ = std::make_unique<ScanReader>(model, sink_);
    openedMono_ = 0;
    const InterfaceUrl url = *InterfaceUrl::parse(address_);
    url_ = address_;
    if (url.scheme == QStringLiteral("serial") && url.option("baud").isEmpty())
        url_ += QString(address_.contains('?') ? "&baud=%1" : "?baud=%1").arg(model.baud);
    const auto filled = [this] {
        QMetaObject::invokeMethod(
            this, [this] { this->filled(); }, Qt::QueuedConnection);
    };
    port_ = std::make_unique<PortThread>("scanner", url_, recording_, reader_->queue(), filled,
                                         [this](const QString &event, const QJsonObject &details) {
                                             if (isFound_) // each try opens it
                                                 note_(event, details);
                                         });
}

void LiveScanner::tryNext() {
    tried_.append(QString(address_.startsWith("serial:") ? "%1 at %2 baud" : "%1")
                      .arg(reader_->model().title)
                      .arg(reader_->model().baud));
    candidate_ = (candidate_ + 1) % candidates_.size();
    if (candidate_ == 0)
        inVain_ = std::exchange(tried_, {});
    stop();
    open(*candidates_[candidate_]);
    start();
}

/// What sends faster than it can be read leaves time for all else.
void LiveScanner::filled() {
    QElapsedTimer working;
    working.start();
    if (!reader_->process([&working] { return working.elapsed() < longestWork_ms; }))
        QMetaObject::invokeMethod(
            this, [this] { filled(); }, Qt::QueuedConnection);
    step();
}

void LiveScanner::step() {
    const PortThread::State state = port_->state();
    const Moment now = Moment::now();
    scan::ScannerProtocol &protocol = reader_->protocol();
    if (state.carrier != Interface::State::Open) {
        openedMono_ = 0;
        return;
    }
    if (openedMono_ == 0) {
        openedMono_ = now.mono();
        protocol.opened(now.mono_ns);
    }
    act(protocol.next(now.mono_ns));
    if (isFound_)
        return;
    const scan::Search verdict = scan::verdictOf(reader_->model(), protocol, now.mono() - openedMono_);
    if (verdict == scan::Search::Other)
        tryNext();
    else
        isFound_ = verdict == scan::Search::Found;
}

const scan::ScannerModel *LiveScanner::model() const {
    if (!isFound_ || told_)
        return told_;
    return scan::namedModel(reader_->model(), reader_->protocol().identity().model);
}

void LiveScanner::act(const scan::HostAction &action) {
    if (action.reopen)
        openedMono_ = 0; // it begins anew
    if (action.send.empty() && !action.dtr && !action.reopen)
        return;
    port_->with([action](Interface &line) {
        auto *const serial = qobject_cast<SerialInterface *>(&line);
        if (serial && action.dtr) // some lines have none
            (void)serial->setSignal(SerialInterface::Signal::Dtr, *action.dtr);
        if (action.reopen) {
            line.close("it is opened anew: the scanner does not answer");
            return line.open();
        }
        line.write(QByteArray::fromStdString(action.send));
        line.flush();
    });
}

} // namespace hermes::scanner
