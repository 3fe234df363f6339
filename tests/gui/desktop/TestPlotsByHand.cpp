#include "common/Time.h"
#include "gui/desktop/view/PlotPane.h"
#include "tests/gui/desktop/PlotWindow.h"

using namespace hermes;
using namespace hermes::desktop;

/// What a real wheel and a real mouse (xdotool) do over a chart, on a display with a window manager
/// (with_display).
class TestPlotsByHand : public QObject, protected PlotWindow {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        if (QGuiApplication::platformName() != "xcb")
            QSKIP("needs a display: tests/gui/desktop/with_display");
        open(drive());
        if (QTest::currentTestFailed())
            return;
        raise();
        QVERIFY(panel_->board().add(field("vx")));
        subscribed("drive");
        for (int i = 0; i < 5; ++i)
            sayVx(stampNow(), 0.1 * i);
        QTRY_VERIFY(pane()->scene().left.most() > 0.4);
    }

    void cleanup() { close(); }

    void wheelAndMouse() {
        xdotool(at(-10) + " click 4"); // up
        QTRY_COMPARE(time().span_s(), 24.0);
        QTRY_VERIFY(time().cursor_s() && std::abs(*time().cursor_s() + 8) < 0.5); // where -10 s was
        QTRY_VERIFY(pane()->scene().cursorTime.startsWith("-8."));
        QVERIFY(!time().isHeld());
        xdotool("keydown shift click 4 keyup shift");
        QTRY_VERIFY(std::abs(time().right_s() + 2.4) < 1e-9);
        QVERIFY(panel_->findChild<QPushButton *>("pause")->isChecked());
        xdotool("keydown ctrl click 4 keyup ctrl");
        QTRY_VERIFY(!pane()->scene().left.isAutomatic());
        QCOMPARE(time().span_s(), 24.0);
        xdotool(at(-20) + " mousedown 1 " + at(-16) + ' ' + at(-14) + " mouseup 1");
        QTRY_VERIFY(std::abs(time().right_s() + 8.4) < 0.3);
        xdotool("click --repeat 2 --delay 50 1");
        QTRY_VERIFY(!time().isHeld());
        QVERIFY(pane()->scene().left.isAutomatic());
        QCOMPARE(time().right_s(), 0.0);
        const QPoint away = window_->window.mapToGlobal({600, 200});
        xdotool(QString("mousemove %1 %2").arg(away.x()).arg(away.y()));
        QTRY_VERIFY(!time().cursor_s());
    }

    void menuOfAPane() {
        xdotool(at(-10) + " click 3");
        QTRY_VERIFY(QApplication::activePopupWidget());
        xdotool("key Up Up Return"); // the last but one
        QTRY_COMPARE(int(panel_->board().panes().size()), 2);
        QTRY_VERIFY(!QApplication::activePopupWidget());
        window_->window.activateWindow();
        QVERIFY(QTest::qWaitForWindowActive(&window_->window));
        PlotPane *const added = panel_->board().panes()[1];
        QTRY_VERIFY(added->height() > 40);
        const QPoint middle = added->mapToGlobal(added->rect().center());
        xdotool(QString("mousemove %1 %2 click 1").arg(middle.x()).arg(middle.y()));
        QTRY_VERIFY(added->hasFocus());
        xdotool("key Menu");
        QTRY_VERIFY(QApplication::activePopupWidget());
        xdotool("key Up Return");
        QTRY_COMPARE(int(panel_->board().panes().size()), 1);
        QVERIFY(panel_->board().has(field("vx")));
    }

private:
    static void xdotool(const QString &words) {
        QProcess program;
        program.start("xdotool", words.split(' '));
        QVERIFY(program.waitForFinished(10000) && program.exitCode() == 0);
    }
    PlotPane *pane() const { return panel_->board().panes()[0]; }
    TimeWindow &time() const { return panel_->board().time(); }
    QString at(double time_s) const {
        const QRectF chart = pane()->painter(pane()->rect()).chart();
        const double x = chart.left() + (time_s - time().left_s()) / time().span_s() * chart.width();
        const QPoint place = pane()->mapToGlobal(QPoint(int(x), int(chart.center().y())));
        return QString("mousemove %1 %2").arg(place.x()).arg(place.y());
    }
};

QTEST_MAIN(TestPlotsByHand)
#include "TestPlotsByHand.moc"
