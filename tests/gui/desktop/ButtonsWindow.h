#pragma once

#include "gui/desktop/model/Macro.h"
#include "tests/gui/desktop/OpenWindow.h"

namespace hermes {

/// For tests of the operator's own buttons: a window on a simulated robot, the buttons that it begins with,
/// and hands that make and press them.
class ButtonsWindow {
protected:
    void startRobot() {
        robot_ = std::make_unique<RobotProcesses>();
        robot_->startMotors();
    }
    void begin() {
        file_ = robot_->path("gui.json");
        QFile::remove(file_);
        client_ =
            std::make_unique<ConnectedClient>(QString("127.0.0.1:%1").arg(robot_->port("motorcontrol")));
    }
    void close() {
        window_.reset();
        drive_.reset();
        fleet_.reset();
        releaseStop(*client_);
        client_.reset();
    }
    void open(const QJsonArray &buttons = {}) {
        if (!buttons.isEmpty())
            keep(QJsonDocument(buttons).toJson());
        fleet_ = std::make_unique<Fleet>();
        robot_->connectTo(*fleet_);
        drive_ = std::make_unique<DriveControl>(*fleet_);
        window_ = std::make_unique<MainWindow>(*fleet_, *drive_, file_);
        window_->show();
        window_->activateWindow();
        QVERIFY(QTest::qWaitForWindowActive(window_.get()));
        QTRY_VERIFY(!drive_->isStopped());
    }
    /// As the buttons of the last window.
    void keep(const QByteArray &buttons) const {
        Layouts layouts(file_);
        layouts.setValue("buttons", QString::fromUtf8(buttons));
        QVERIFY(layouts.save().ok());
    }
    template <typename T>
    T *find(const QString &name) const {
        return window_->findChild<T *>(name);
    }
    void click(const QString &name) { OpenWindow::click(window_.get(), name); }
    QPushButton *button(int place) const {
        for (auto *const found : window_->findChildren<QPushButton *>(QString("macro%1").arg(place)))
            if (found->isVisible() && found->height() > 10) // is laid out
                return found;
        return nullptr;
    }
    QString title(int place) const { return button(place) ? button(place)->text() : QString(); }
    void press(int place) {
        QTRY_VERIFY(button(place) && button(place)->isEnabled());
        QTest::mouseClick(button(place), Qt::LeftButton);
    }
    QString text() const { return find<QLabel>("macroText")->text(); }
    void chooseMethod(const QString &daemon, const QString &method) {
        auto *const dock = find<QDockWidget>("commands");
        dock->show();
        dock->raise();
        fleet_->choose(fleet_->robot()->withName(daemon));
        auto *const methods = find<QListWidget>("methods");
        QTRY_VERIFY(!methods->findItems(method, Qt::MatchExactly).isEmpty());
        QListWidgetItem *const found = methods->findItems(method, Qt::MatchExactly)[0];
        methods->scrollToItem(found);
        QTest::mouseClick(methods->viewport(), Qt::LeftButton, {}, methods->visualItemRect(found).center());
    }
    void typeParameter(const QString &name, const QString &value) {
        auto *const call = find<QPushButton>("call")->parentWidget()->parentWidget();
        OpenWindow::type(call->findChild<QWidget *>(name)->findChild<QLineEdit *>(), value);
    }
    QJsonValue ask(const QString &method, const QJsonObject &params = {}) {
        const auto answer = client_->callAndWait(method, params);
        return answer ? *answer : QJsonValue();
    }
    /// Where the simulated robot is.
    double x() {
        Client simulator;
        simulator.connectTo(QString("127.0.0.1:%1").arg(robot_->port("simulator")));
        if (!simulator.waitConnected().ok())
            return qQNaN();
        const auto state = simulator.callAndWait("sim.state");
        return state ? (*state)["pose"]["x"].toDouble() : qQNaN();
    }
    static QJsonObject step(const QString &daemon, const QString &method, const QJsonObject &params = {},
                            double pause_s = 0) {
        return {{"robot", "127.0.0.1"},
                {"daemon", daemon},
                {"method", method},
                {"params", params},
                {"pause_s", pause_s}};
    }
    static QJsonObject place(double x, double pause_s = 0) {
        return step("simulator", "sim.place", {{"x", x}, {"y", 0}, {"theta", 0}}, pause_s);
    }
    static QJsonObject macro(const QString &name, const QJsonArray &steps) {
        return {{"name", name}, {"steps", steps}};
    }

    std::unique_ptr<RobotProcesses> robot_;
    std::unique_ptr<Fleet> fleet_;
    std::unique_ptr<DriveControl> drive_;
    std::unique_ptr<MainWindow> window_;
    std::unique_ptr<Client> client_; // an independent eye on the motors
    QString file_;
};

} // namespace hermes
