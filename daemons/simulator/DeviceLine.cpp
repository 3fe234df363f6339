#include "daemons/simulator/DeviceLine.h"

namespace hermes::simulator {

Result<std::shared_ptr<PtyInterface>> openDeviceLine(const QString &link) {
    InterfaceUrl url;
    url.scheme = "pty";
    url.path = link;
    auto pty = std::make_shared<PtyInterface>(url, nullptr);
    QString failure;
    const auto watch = QObject::connect(pty.get(), &Interface::closed, pty.get(),
                                        [&failure](const QString &why) { failure = why; });
    pty->open();
    QObject::disconnect(watch);
    if (!pty->isOpen())
        return Error(ErrorCode::InputOutput, failure);
    return pty;
}

} // namespace hermes::simulator
