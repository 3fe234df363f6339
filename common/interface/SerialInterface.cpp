#include "common/interface/SerialInterface.h"

#include "common/interface/SerialDriver.h"

#include <cerrno>

namespace hermes {
namespace {

constexpr int usualBaud = 115200;

template <typename T>
struct Choice {
    const char *text;
    T value;
};

constexpr Choice<QSerialPort::DataBits> dataBits[] = {{"5", QSerialPort::Data5},
                                                      {"6", QSerialPort::Data6},
                                                      {"7", QSerialPort::Data7},
                                                      {"8", QSerialPort::Data8}};
constexpr Choice<QSerialPort::Parity> parities[] = {
    {"none", QSerialPort::NoParity}, {"even", QSerialPort::EvenParity}, {"odd", QSerialPort::OddParity}};
constexpr Choice<QSerialPort::StopBits> stopBits[] = {{"1", QSerialPort::OneStop},
                                                      {"2", QSerialPort::TwoStop}};
constexpr Choice<QSerialPort::FlowControl> flows[] = {{"none", QSerialPort::NoFlowControl},
                                                      {"hardware", QSerialPort::HardwareControl},
                                                      {"software", QSerialPort::SoftwareControl}};

/// Sets target to what the URL's option means; gives what is wrong with it, or an empty text.
template <typename T, std::size_t N>
QString choose(const InterfaceUrl &url, const char *option, const char *fallback,
               const Choice<T> (&choices)[N], T &target) {
    const QString text = url.option(QLatin1String(option), QLatin1String(fallback));
    QStringList known;
    for (const Choice<T> &choice : choices) {
        if (text == QLatin1String(choice.text)) {
            target = choice.value;
            return {};
        }
        known.append(QLatin1String(choice.text));
    }
    return QString("%1 is \"%2\", expected one of: %3").arg(QLatin1String(option), text, known.join(", "));
}

/// What the system says of a pseudo-terminal whose other end is gone helps nobody.
QString reasonOf(const QSerialPort &port) {
    const QString text = port.errorString();
    return text == qt_error_string(ENOTTY) ? "it is no serial device, or none any more" : text;
}

} // namespace

SerialInterface::SerialInterface(const InterfaceUrl &address, QObject *parent)
    : Interface(parent)
    , url_(address) {
    // Not readAll(), which for some bytes moves 32 KB: half of what the motor control would do.
    connect(&port_, &QSerialPort::readyRead, this,
            [this] { nowReceived(port_.read(port_.bytesAvailable())); });
    connect(&port_, &QSerialPort::bytesWritten, this, &Interface::drained);
    connect(&port_, &QSerialPort::errorOccurred, this, &SerialInterface::fail);
}

QString SerialInterface::configure() {
    const QString baudText = url_.option("baud", QString::number(usualBaud));
    const int baud = baudText.toInt();
    if (baud <= 0)
        return QString("baud \"%1\" is not a number above 0").arg(baudText);
    const QString pace = url_.option("pace", baudText);
    if (pace.toInt() <= 0)
        return QString("pace \"%1\" is not a number above 0").arg(pace);
    QSerialPort::DataBits data = QSerialPort::Data8;
    QSerialPort::Parity parity = QSerialPort::NoParity;
    QSerialPort::StopBits stop = QSerialPort::OneStop;
    QSerialPort::FlowControl flow = QSerialPort::NoFlowControl;
    for (const QString &wrong :
         {choose(url_, "data_bits", "8", dataBits, data), choose(url_, "parity", "none", parities, parity),
          choose(url_, "stop_bits", "1", stopBits, stop), choose(url_, "flow", "none", flows, flow)}) {
        if (!wrong.isEmpty())
            return wrong;
    }
    port_.setBaudRate(baud);
    port_.setDataBits(data);
    port_.setParity(parity);
    port_.setStopBits(stop);
    port_.setFlowControl(flow);
    return {};
}

void SerialInterface::doOpen() {
    if (url_.path.isEmpty())
        return nowClosed(
            QString("%1: a device is missing, as in serial:///dev/ttyS1?baud=115200").arg(name()), true);
    const QString wrong = configure();
    if (!wrong.isEmpty())
        return nowClosed(QString("%1: %2").arg(name(), wrong), true);
    const QString device = serialDevice(url_.path);
    if (device.isEmpty())
        return nowClosed(QString("cannot open %1: there is no such device").arg(name()), true);
    port_.setPortName(device);
    if (!port_.open(QIODevice::ReadWrite)) {
        const QString reason =
            port_.error() == QSerialPort::PermissionError
                ? QString("in use by another program, or not permitted (%1)").arg(reasonOf(port_))
                : reasonOf(port_);
        return nowClosed(QString("cannot open %1: %2").arg(name(), reason), true);
    }
    port_.clear();
    errorsAtOpening_ = driverErrors();
    nowOpen();
}

QMap<QString, quint64> SerialInterface::driverErrors() const {
    return port_.isOpen() ? serialErrors(port_.handle()) : QMap<QString, quint64>();
}

QMap<QString, quint64> SerialInterface::systemErrors() const {
    QMap<QString, quint64> errors = driverErrors(); // since the driver was loaded
    for (auto error = errors.begin(); error != errors.end(); ++error)
        *error -= std::min(*error, errorsAtOpening_.value(error.key()));
    return errors;
}

qint64 SerialInterface::bytesInSystem() const {
    return port_.isOpen() ? serialBytesWaiting(port_.handle()) : 0;
}

double SerialInterface::bytesPerSecond() const {
    const auto bits = [this](const char *option, int usual) {
        return url_.option(QLatin1String(option), QString::number(usual)).toInt();
    };
    const int parity = url_.option("parity", "none") != "none";
    const int baud = bits("baud", usualBaud),
              frame = 1 + bits("data_bits", 8) + parity + bits("stop_bits", 1);
    return double(std::min(baud, bits("pace", baud))) / std::max(frame, 1);
}

void SerialInterface::doClose() {
    port_.flush();
    port_.close();
}

Result<void> SerialInterface::setSignal(Signal signal, bool on) {
    const char *const text = signal == Signal::Rts ? "RTS" : "DTR";
    if (!isOpen())
        return Error(ErrorCode::NotReady, QString("%1 is not open").arg(name()));
    const SerialLine line = signal == Signal::Rts ? SerialLine::Rts : SerialLine::Dtr;
    if (const QString wrong = setSerialLine(port_.handle(), line, on); !wrong.isEmpty())
        return Error(ErrorCode::DeviceFault,
                     QString("%1: cannot set %2: %3").arg(name(), QLatin1String(text), wrong));
    return {};
}

void SerialInterface::fail(QSerialPort::SerialPortError error) {
    if (error == QSerialPort::NoError || !isOpen())
        return; // doOpen() tells what goes wrong there
    const QString reason = reasonOf(port_);
    port_.close();
    nowClosed(QString("%1: the device is gone or failed: %2").arg(name(), reason), true);
}

} // namespace hermes
