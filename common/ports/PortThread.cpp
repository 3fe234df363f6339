#include "common/ports/PortThread.h"

#include "common/Realtime.h"
#include "common/interface/InterfaceRegistry.h"

#include <QFileInfo>

namespace hermes {

namespace {

constexpr std::chrono::milliseconds longestRetry{250}; // what is sent to a closed port is lost
constexpr int errorPeriod_ms = 1000;
constexpr int realtimePriority = 5; // below the loops that drive motors

} // namespace

PortThread::PortThread(const QString &name, const QString &url, ChunkQueue &recording, ChunkQueue &view,
                       std::function<void()> viewFilled, Note note)
    : url_(url)
    , recording_(recording)
    , view_(view)
    , viewFilled_(std::move(viewFilled))
    , note_(std::move(note)) {
    setObjectName("port " + name);
    context_.moveToThread(this);
}

void PortThread::end() {
    quit();
    wait();
}

PortThread::State PortThread::state() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return state_;
}

void PortThread::run() {
    if (url_.startsWith("serial:"))       // a driver keeps 4 KiB: 44 ms of 921,600 baud
        becomeRealtime(realtimePriority); // where it may
    InterfaceUrl url = *InterfaceUrl::parse(url_);
    if (url.scheme == QStringLiteral("udp") && url.option("from").isEmpty())
        url.options.insert("from", "first"); // not two devices mixed into one
    const Result<Interface *> made = makeInterface(url, nullptr);
    const std::unique_ptr<Interface> carrier(*made); // the settings were checked
    carrier_ = carrier.get();
    carrier->setReconnecting(true);
    carrier->setLongestRetry(longestRetry);
    connect(carrier_, &Interface::received, carrier_, [this](const QByteArray &bytes) { received(bytes); });
    connect(carrier_, &Interface::opened, carrier_, [this] { changed({}); });
    connect(carrier_, &Interface::closed, carrier_, [this](const QString &reason) { changed(reason); });
    QTimer errorTimer;
    connect(&errorTimer, &QTimer::timeout, carrier_, [this] { checkErrors(); });
    errorTimer.start(errorPeriod_ms);
    carrier->open();
    exec();
    carrier->disconnect(carrier_); // that it ends is no fault of the line
    carrier->close();
    carrier_ = nullptr;
}

void PortThread::received(const QByteArray &bytes) {
    const Moment now = Moment::now();
    const auto size = std::size_t(bytes.size());
    recording_.push(bytes.constData(), size, now);
    if (view_.push(bytes.constData(), size, now))
        viewFilled_();
    const std::lock_guard<std::mutex> lock(mutex_);
    state_.counters = carrier_->counters();
    state_.last = now;
}

void PortThread::changed(const QString &reason) {
    const bool isOpen = carrier_->isOpen();
    bool wasOpen;
    QString device;
    if (isOpen && url_.startsWith("serial:"))
        device = QFileInfo(InterfaceUrl::parse(url_)->path).canonicalFilePath();
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        wasOpen = state_.carrier == Interface::State::Open;
        state_.carrier = carrier_->state();
        state_.counters = carrier_->counters();
        state_.reason = reason;
        state_.device = device;
    }
    if (isOpen)
        note_("opened", {{"device", device}});
    else if (wasOpen) // not each attempt
        note_("closed", {{"reason", reason}});
    for (auto error = errorsNow_.begin(); error != errorsNow_.end(); ++error)
        errorsBefore_[error.key()] += *error;
    errorsNow_.clear();
}

void PortThread::checkErrors() {
    if (!carrier_->isOpen())
        return;
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        state_.strangers = carrier_->strangers();
    }
    const QMap<QString, quint64> errors = carrier_->systemErrors();
    if (errors == errorsNow_)
        return;
    QJsonObject more;
    QMap<QString, quint64> sum = errorsBefore_;
    for (auto error = errors.begin(); error != errors.end(); ++error) {
        sum[error.key()] += *error;
        if (*error > errorsNow_.value(error.key()))
            more.insert(error.key(), double(*error - errorsNow_.value(error.key())));
    }
    errorsNow_ = errors;
    if (!more.isEmpty())
        note_("errors", more);
    const std::lock_guard<std::mutex> lock(mutex_);
    state_.systemErrors = sum;
}

void PortThread::with(std::function<void(Interface &)> job) {
    const auto run = [this, job = std::move(job)] {
        job(*carrier_);
        const std::lock_guard<std::mutex> lock(mutex_);
        state_.counters = carrier_->counters();
    };
    QMetaObject::invokeMethod(&context_, run, Qt::QueuedConnection);
}

} // namespace hermes
