#pragma once

#include "gui/desktop/panels/MapPanel.h"
#include "tests/gui/desktop/OpenWindow.h"

#include <QMouseEvent>

namespace hermes {

/// For tests of the map: a window on a robot that stands in a simulated hall.
class MapWindow {
protected:
    void open() {
        robot_ = std::make_unique<RobotProcesses>();
        robot_->startAll();
        window_ = std::make_unique<OpenWindow>(*robot_);
        QVERIFY(window_->show());
        QTRY_VERIFY_WITH_TIMEOUT(model().pose() && model().edges().size() > 10, 20000);
    }
    MapPanel *panel() const { return window_->window.findChild<MapPanel *>(); }
    MapView &view() const { return panel()->view(); }
    const MapModel &model() const { return panel()->model(); }
    QString message() const { return panel()->findChild<QLabel *>("message")->text(); }
    void tool(const QString &name) const {
        auto *const bar = panel()->findChild<QToolBar *>();
        auto *const button = bar->widgetForAction(panel()->findChild<QAction *>(name));
        QVERIFY2(button && button->isEnabled(), qPrintable(name));
        QTest::mouseClick(button, Qt::LeftButton);
    }
    QPoint pixel(double x, double y) const { return view().transform().map(QPointF(x, y)).toPoint(); }
    void drag(QPoint from, QPoint to) const {
        QTest::mousePress(&view(), Qt::LeftButton, {}, from);
        QMouseEvent move(QEvent::MouseMove, to, Qt::NoButton, Qt::LeftButton, {});
        QApplication::sendEvent(&view(), &move);
        QTest::mouseRelease(&view(), Qt::LeftButton, {}, to);
    }
    double scale() const { return view().transform().m11(); }

    std::unique_ptr<RobotProcesses> robot_;
    std::unique_ptr<OpenWindow> window_;
};

} // namespace hermes
