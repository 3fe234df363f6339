#include "gui/desktop/view/CurveLine.h"
#include "gui/desktop/view/PlotPane.h"
#include "tests/support/ThreadTime.h"

#include <QImage>
#include <QWheelEvent>

using namespace hermes;
using namespace hermes::desktop;

/// One chart by itself: its lines, axes, cursor, and what the mouse does with it.
class TestPlotPane : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        pane_.reset();
        time_ = std::make_unique<TimeWindow>();
        pane_ = std::make_unique<PlotPane>(*time_);
        connect(time_.get(), &TimeWindow::changed, pane_.get(), &PlotPane::refresh);
        pane_->resize(1000, 300);
        pane_->show();
        samples_ = wave(600, 20);
        add(samples_);
    }

    void linesHoldEveryExtreme() {
        Samples samples = wave(600, 0.7);
        samples[5000].setY(9);
        samples[7001].setY(-8);
        const ChartFrame frame{{0, 0, 500, 100}, now - 600, now, -10, 10};
        const QVector<QPolygonF> lines = curveLines(samples, frame);
        QCOMPARE(lines.size(), 1);
        QVERIFY2(lines[0].size() <= 4 * 502, qPrintable(QString::number(lines[0].size())));
        double highest = 100, lowest = 0, last = -1;
        for (const QPointF &point : lines[0]) {
            highest = std::min(highest, point.y());
            lowest = std::max(lowest, point.y());
            QVERIFY(point.x() >= last);
            last = point.x();
        }
        QCOMPARE(highest, frame.y(9));
        QCOMPARE(lowest, frame.y(-8));
        QCOMPARE(last, 500.0);
    }

    void noLineWhereSamplesAreMissing() {
        Samples samples = wave(60, 20);
        samples.erase(samples.begin() + 400, samples.begin() + 600); // ten seconds
        const QVector<QPolygonF> lines = curveLines(samples, {{0, 0, 2000, 100}, now - 60, now, -1, 1});
        QCOMPARE(lines.size(), 2);
        QCOMPARE(lines[0].size() + lines[1].size(), int(samples.size()));
        // Few samples have no usual distance: they are joined.
        const Samples few{{now - 50, 1}, {now - 20, 2}};
        QCOMPARE(curveLines(few, {{0, 0, 100, 100}, now - 60, now, 0, 3}).constFirst().size(), 2);
    }

    void linesEndAtTheEdges() {
        const Samples samples{{now - 100, 0}, {now - 50, 1}, {now, 2}};
        const ChartFrame frame{{0, 0, 100, 100}, now - 30, now - 20, 0, 2};
        const QVector<QPolygonF> lines = curveLines(samples, frame);
        QCOMPARE(lines.size(), 1);
        QCOMPARE(lines[0], QPolygonF(QVector<QPointF>{{0, frame.y(1.4)}, {100, frame.y(1.6)}}));
        QVERIFY(curveLines(samples, {{0, 0, 100, 100}, now + 10, now + 20, 0, 2}).constFirst().isEmpty());
        QVERIFY(curveLines({}, frame).constFirst().isEmpty());
    }

    void ticksAreRound_data() {
        const Rows<double, double, QStringList> row("least", "most", "texts");
        row("speeds", -0.1, 0.52, {"0.0", "0.2", "0.4"});
        row("seconds", -30.0, 0.0, {"-30", "-20", "-10", "0"});
        row("volts", 24.301, 24.317, {"24.305", "24.310", "24.315"});
        row("large", -1e15, 1e15, {"-1e+15", "0", "1e+15"});
        row("nothing", 1.0, 1.0, {});
        row("endless", 0.0, std::numeric_limits<double>::infinity(), {});
    }

    void ticksAreRound() {
        FETCH(double, least, double, most);
        QStringList texts;
        for (const Tick &tick : ticks(least, most, 4))
            texts.append(tick.text);
        QTEST(texts, "texts");
    }

    void wheelChangesTheTime() {
        wheel(-10, 1);
        QCOMPARE(time_->span_s(), 24.0);
        QCOMPARE(time_->right_s(), 0.0); // now stays in sight
        QVERIFY(!time_->isHeld());
        for (int i = 0; i < 40; ++i)
            wheel(-10, -1);
        QCOMPARE(time_->span_s(), 600.0);
        time_->setHeld(true);
        wheel(-100, 4);
        QVERIFY(time_->right_s() < -40 && time_->left_s() < -100); // about the mouse
        QCOMPARE(time_->span_s(), 600 / std::pow(1.25, 4));
        for (int i = 0; i < 60; ++i)
            wheel(-100, 1);
        QCOMPARE(time_->span_s(), 0.5);
    }

    void shiftWheelAndDragGoBack() {
        wheel(-10, 2, Qt::ShiftModifier);
        QVERIFY(time_->isHeld());
        QCOMPARE(time_->right_s(), -6.0);
        wheel(-10, -3, Qt::ShiftModifier); // beyond now
        QVERIFY(!time_->isHeld());
        QCOMPARE(time_->right_s(), 0.0);

        const QPoint from = at(-20).toPoint(), to = at(-10).toPoint();
        QTest::mousePress(pane_.get(), Qt::LeftButton, {}, from);
        moveTo(from + QPoint(2, 0), Qt::LeftButton); // a click is no request to look elsewhere
        QVERIFY(!time_->isHeld());
        moveTo((from + to) / 2, Qt::LeftButton);
        moveTo(to, Qt::LeftButton);
        QTest::mouseRelease(pane_.get(), Qt::LeftButton, {}, to);
        QVERIFY2(std::abs(time_->right_s() + 10) < 0.2, qPrintable(QString::number(time_->right_s())));
        for (int i = 0; i < 200; ++i)
            wheel(time_->left_s() + 1, 1, Qt::ShiftModifier);
        QCOMPARE(time_->left_s(), -600.0); // no more is kept

        QSignalSpy live(pane_.get(), &PlotPane::liveWanted);
        QTest::mouseDClick(pane_.get(), Qt::LeftButton, {}, to);
        QCOMPARE(live.count(), 1);
    }

    void ctrlWheelZoomsTheValues() {
        const ValueAxis &axis = pane_->scene().left;
        const double before = axis.most() - axis.least(), middle = axis.most() + axis.least();
        wheel(-10, 2, Qt::ControlModifier);
        QVERIFY(std::abs((axis.most() - axis.least()) - before / 1.5625) < 1e-9);
        QVERIFY(std::abs(axis.most() + axis.least() - middle) < 0.02); // the mouse was in the middle
        QVERIFY(!axis.isAutomatic());
        QCOMPARE(time_->span_s(), 30.0);
        pane_->refresh();
        QVERIFY(axis.most() < 0.9); // stays
        for (int i = 0; i < 400; ++i)
            wheel(-10, i < 200 ? 1 : -1, Qt::ControlModifier);
        QVERIFY(axis.most() > axis.least() && std::isfinite(axis.most()));
        pane_->scene().left.automate();
        pane_->refresh();
        QVERIFY(axis.most() > 1 && axis.most() < 1.3);
    }

    void keysDoTheSame() {
        QSignalSpy live(pane_.get(), &PlotPane::liveWanted);
        QTest::keyClick(pane_.get(), Qt::Key_PageDown);
        QVERIFY(!time_->isHeld());
        QTest::keyClick(pane_.get(), Qt::Key_PageUp);
        QCOMPARE(time_->right_s(), -15.0);
        QTest::keyClick(pane_.get(), Qt::Key_Home);
        QCOMPARE(time_->left_s(), -600.0);
        QTest::keyClick(pane_.get(), Qt::Key_PageUp, Qt::ControlModifier);
        QVERIFY(!pane_->scene().left.isAutomatic());
        QTest::keyClick(pane_.get(), Qt::Key_End);
        QCOMPARE(live.count(), 1);
    }

    void cursorTellsTheNearestSample() {
        QCOMPARE(pane_->valueText(0), QString("0 m/s")); // the newest
        for (const double time_s : {-3.2, -7.77, -25.0}) {
            const QPoint place = at(time_s).toPoint();
            moveTo(place);
            QVERIFY(time_->cursor_s());
            QVERIFY(std::abs(*time_->cursor_s() - time_s) < 0.05);
            const double nearest_s = std::round(*time_->cursor_s() / 0.05) * 0.05;
            const double value = std::sin(nearest_s * 2 * M_PI / 20);
            const QString text = pane_->valueText(0);
            QVERIFY2(text.endsWith(" m/s") && std::abs(text.section(' ', 0, 0).toDouble() - value) < 6e-4,
                     qPrintable(text));
        }
        time_->setCursor(-3.2);
        const Samples late{{now - 1, 5}};
        add(late, "late");
        QCOMPARE(pane_->valueText(1), QString("–")); // none was there
        const Samples slow{{now - 20, 5}, {now - 2, 6}};
        add(slow, "slow");
        QCOMPARE(pane_->valueText(2), QString("6 m/s")); // on a line, the nearer
        pane_->scene().lines[0].silence = "no data for 3 s";
        QVERIFY(pane_->valueText(0) != "no data for 3 s"); // of then
        time_->setCursor(std::nullopt);
        QCOMPARE(pane_->valueText(0), QString("no data for 3 s"));
    }

    void valuesBeyondAreDrawn() {
        const Samples beyond{
            {now - 20, 1e15}, {now - 10, -1e15}, {now - 5, 1e-300}, {now - 5, 0}, {now, 1e15}};
        const Samples alone{{now - 3, 4}};
        add(beyond, QString(10000, 'W'));
        add(alone, QString(QChar(0x202e)) + "right to left");
        wheel(-10, 30, Qt::ControlModifier);
        QVERIFY(!pane_->grab().isNull());
        pane_->resize(160, 56);
        QVERIFY(!pane_->grab().isNull());
        pane_->scene().lines.clear();
        QVERIFY(!pane_->grab().isNull());
    }

    // Ten minutes of twelve curves, 20 times a second: at most half of the time.
    void redrawOfTwelveCurves() {
        std::vector<Samples> all;
        for (int i = 0; i < 12; ++i)
            all.push_back(wave(600, 1 + 7 * i));
        pane_->scene().lines.clear();
        for (const Samples &samples : all)
            add(samples, "curve");
        time_->setSpan(600);
        double best_ms = 1e9;
        QImage image(pane_->size(), QImage::Format_RGB32);
        for (int i = 0; i < 15; ++i) {
            const double before_ms = threadTime_ms();
            pane_->refresh();
            QPainter painter(&image);
            pane_->painter(pane_->rect()).paint(painter);
            painter.end();
            best_ms = std::min(best_ms, threadTime_ms() - before_ms);
        }
        qInfo("%.2f ms", best_ms);
        QVERIFY2(best_ms < 25 * slowness, qPrintable(QString::number(best_ms)));
    }

private:
    static constexpr double now = 1.7e9;

    /// So many seconds of a wave at 20 Hz.
    static Samples wave(double seconds, double period_s) {
        Samples samples;
        for (int i = int(-seconds * 20); i <= 0; ++i)
            samples.push_back({now + i * 0.05, std::sin(i * 0.05 * 2 * M_PI / period_s)});
        return samples;
    }
    void add(const Samples &samples, const QString &name = "wave") {
        PlotLine line;
        line.field = {"host:1", "topic", name};
        line.name = name;
        line.unit = "m/s";
        line.now = now;
        line.samples = &samples;
        pane_->scene().lines.push_back(line);
        pane_->refresh();
    }
    QPointF at(double time_s) const { // on the line in the middle
        const QRectF chart = pane_->painter(pane_->rect()).chart();
        return {chart.left() + (time_s - time_->left_s()) / time_->span_s() * chart.width(),
                chart.center().y()};
    }
    void moveTo(const QPoint &place, Qt::MouseButtons buttons = Qt::NoButton) {
        QMouseEvent move(QEvent::MouseMove, place, pane_->mapToGlobal(place), Qt::NoButton, buttons, {});
        QApplication::sendEvent(pane_.get(), &move);
    }
    void wheel(double time_s, int steps, Qt::KeyboardModifiers keys = Qt::NoModifier) {
        const QPointF place = at(time_s);
        QWheelEvent event(place, pane_->mapToGlobal(place.toPoint()), {}, {0, 120 * steps}, Qt::NoButton,
                          keys, Qt::NoScrollPhase, false);
        QApplication::sendEvent(pane_.get(), &event);
        QVERIFY(event.isAccepted());
    }

    std::unique_ptr<TimeWindow> time_;
    std::unique_ptr<PlotPane> pane_;
    Samples samples_;
};

QTEST_MAIN(TestPlotPane)
#include "TestPlotPane.moc"
