#include "gui/desktop/view/PointOpenGl.h"
#include "gui/desktop/view/PointRaster.h"
#include "tests/gui/desktop/CloudSession.h"
#include "tests/gui/desktop/OpenWindow.h"

using namespace hermes;

/// As a driver that has lost its device.
class FailingRenderer : public PointRenderer {
public:
    const QImage *draw(const PointPicture &) override { return nullptr; }
    bool isByOpenGl() const override { return true; }
};

/// How the cloud is drawn, by OpenGL and without. What needs OpenGL is skipped where there is none.
class TestCloudDrawing : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void nearestPointIsSeen() {
        CloudCamera camera;
        camera.reset(5);
        camera.orbit(0, 90); // from above: ahead is up
        const std::array<quint8, 4> red{255, 0, 0, 255}, blue{0, 0, 255, 255};
        const QSize size(101, 101);
        PointRaster raster;
        for (const bool isRedFirst : {true, false}) {
            const CloudVertex high{0, 0, 1, red}, low{0, 0, -1, blue}, ahead{2, 0, 0, blue};
            const std::vector<CloudVertex> points = isRedFirst ? std::vector<CloudVertex>{high, low, ahead}
                                                               : std::vector<CloudVertex>{ahead, low, high};
            const QImage picture = *raster.draw({points, 1, camera.matrix(size), size, 2});
            QCOMPARE(picture.pixelColor(50, 50), QColor(Qt::red));
            bool isAheadAbove = false;
            for (int y = 0; y < 45; ++y)
                isAheadAbove |= picture.pixelColor(50, y) == QColor(Qt::blue);
            QVERIFY(isAheadAbove);
            QCOMPARE(picture.pixelColor(10, 90).alpha(), 0);
        }
        // Behind the eye, and where no arithmetic leads.
        const float inf = std::numeric_limits<float>::infinity(),
                    nan = std::numeric_limits<float>::quiet_NaN();
        const std::vector<CloudVertex> strange{
            {0, 0, 900, red}, {inf, 0, 0, red}, {nan, nan, nan, red}, {1e30F, -1e30F, 1e30F, red}};
        raster.draw({strange, 2, camera.matrix(size), size, 2});
    }

    void goesOnWithoutOpenGl() {
        CloudSession s;
        auto *const way = s.panel.findChild<QLabel *>("cloudWay");
        s.panel.model().take(wholeTurn());
        s.panel.view().setRenderer(std::make_unique<FailingRenderer>());
        QVERIFY(way->text().isEmpty());
        QVERIFY(colouredPixels(s.panel.view()) > 300);
        QVERIFY(!s.panel.view().renderer()->isByOpenGl());
        QCOMPARE(way->text(), QString("without graphics card"));
        s.panel.findChild<QComboBox *>("cloudColour")->setCurrentIndex(1);
        QVERIFY(colouredPixels(s.panel.view()) > 300);
    }

    // The same picture, whatever draws it.
    void openGlDrawsAlike() {
        QVERIFY(!openGl("off"));
        auto time = runningTimer();
        if (const auto loading = PointOpenGl::load()) {
            loading->start();
            QVERIFY(loading->wait(20000));
        }
        const double loaded_ms = double(time.nsecsElapsed()) * 1e-6;
        time.restart();
        const auto byOpenGl = openGl("on");
        if (!byOpenGl)
            QSKIP("no OpenGL here");
        figure("the driver of OpenGL is loaded beside the window in", loaded_ms, "ms");
        figure("OpenGL begins in", double(time.nsecsElapsed()) * 1e-6, "ms");
        CloudSession s;
        CloudScene &scene = s.panel.view().scene();
        for (const int step : {1, 7}) { // fewer points come after many
            CloudMessage turn = wholeTurn();
            for (auto *const values : {&turn.x, &turn.y, &turn.z})
                values->resize(values->size() / std::size_t(step));
            s.panel.model().take(turn);
            const QSize size(400, 300);
            const PointPicture wanted{scene.vertices(), scene.revision(), scene.camera.matrix(size), size, 2};
            const QImage *const drawn = byOpenGl->draw(wanted);
            QVERIFY(drawn);
            PointRaster raster;
            const QImage *const other = raster.draw(wanted);
            int points = 0, unlike = 0;
            for (int y = 0; y < size.height(); ++y)
                for (int x = 0; x < size.width(); ++x) {
                    const bool isPoint = qAlpha(drawn->pixel(x, y)) > 0;
                    points += isPoint;
                    unlike += isPoint != (qAlpha(other->pixel(x, y)) > 0);
                }
            QVERIFY2(points > 1000 && unlike < points / 5, saying("%1 of %2 pixels differ", unlike, points));
        }
    }

    // The view begins without it and goes over when its driver is loaded.
    void openGlIsLoadedBesideTheWindow() {
        if (!openGl("on"))
            QSKIP("no OpenGL here");
        qputenv("HERMES_OPENGL", "on");
        Fleet fleet;
        CloudPanel panel(fleet);
        panel.show();
        QVERIFY(!panel.view().renderer()->isByOpenGl());
        QTRY_VERIFY(panel.view().renderer()->isByOpenGl());
        qunsetenv("HERMES_OPENGL");
        panel.model().take(wholeTurn());
        QVERIFY(colouredPixels(panel.view()) > 300);
        QVERIFY(panel.view().renderer()->isByOpenGl());
        QVERIFY(panel.findChild<QLabel *>("cloudWay")->text().isEmpty());
    }

    // A panel that gets a window of its own.
    void floatsAndComesBack() {
        OpenWindow open;
        QVERIFY(open.show());
        auto *const panel = open.panel<CloudPanel>("cloud");
        auto *const dock = open.window.findChild<QDockWidget *>("cloud");
        for (const bool isFloating : {false, true, false}) {
            dock->setFloating(isFloating);
            dock->raise();
            QTRY_VERIFY(panel->model().isEnabled());
            const auto areSeen = [panel] {
                panel->model().take(wholeTurn());
                return colouredPixels(panel->view()) > 300;
            };
            QTRY_VERIFY(areSeen());
        }
    }

    void framesOfAWholeTurn_data() { falseAndTrue("isByOpenGl", "without OpenGL", "by OpenGL"); }

    void framesOfAWholeTurn() {
        QFETCH(bool, isByOpenGl);
        const CloudMessage turn = wholeTurn();
        OpenWindow open;
        QVERIFY(open.show());
        auto *const dock = open.window.findChild<QDockWidget *>("cloud");
        auto *const panel = open.panel<CloudPanel>("cloud");
        std::unique_ptr<PointRenderer> renderer = std::make_unique<PointRaster>();
        if (isByOpenGl && !(renderer = openGl("on")))
            QSKIP("no OpenGL here");
        panel->view().setRenderer(std::move(renderer));
        dock->setFloating(true);
        dock->resize(1280, 720);
        QTRY_VERIFY(panel->view().width() > 1200 && panel->view().height() > 500);
        std::vector<double> message_ms, frame_ms;
        QElapsedTimer whole, one;
        for (whole.start(); whole.elapsed() < 3000;) {
            one.start();
            panel->model().take(turn);
            message_ms.push_back(double(one.nsecsElapsed()) * 1e-6);
            QCOMPARE(panel->model().points().size(), turn.x.size());
            one.restart();
            panel->view().repaint();
            frame_ms.push_back(double(one.nsecsElapsed()) * 1e-6);
            QCoreApplication::processEvents();
        }
        const double rate = double(frame_ms.size()) / (double(whole.elapsed()) / 1000);
        const QByteArray name = QByteArray("cloud of 69,440 points, ") + QTest::currentDataTag();
        qInfo("%d x %d pixels", panel->view().width(), panel->view().height());
        figure(name + ", a turn is taken and coloured, median", median(message_ms), "ms");
        figure(name + ", a frame, median", median(frame_ms), "ms");
        figure(name + ", turns taken and shown", rate, "a second");
        QVERIFY2(rate > 10.0 / slowness, saying(rate));
    }

private:
    /// Null: not here. request: of $HERMES_OPENGL.
    static std::unique_ptr<PointOpenGl> openGl(const char *request) {
        const QByteArray before = qgetenv("HERMES_OPENGL");
        qputenv("HERMES_OPENGL", request);
        auto made = PointOpenGl::make();
        before.isNull() ? qunsetenv("HERMES_OPENGL") : qputenv("HERMES_OPENGL", before);
        return made;
    }

    static double median(std::vector<double> values) {
        std::sort(values.begin(), values.end());
        return values[values.size() / 2];
    }
};
