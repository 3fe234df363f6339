#include "gui/desktop/Banners.h"

#include "gui/desktop/drive/StopBanner.h"
#include "gui/desktop/widgets/Arrangement.h"

#include <QMainWindow>
#include <QToolBar>

namespace hermes::desktop {
namespace {

constexpr std::chrono::seconds noticeTime{20};

} // namespace

QToolBar *addFixedBar(QMainWindow &window, Qt::ToolBarArea area, const QString &title, const char *name,
                      QWidget *content) {
    auto *const bar = named(new QToolBar(title, &window), name);
    bar->setMovable(false);
    bar->setContextMenuPolicy(Qt::PreventContextMenu);
    bar->addWidget(content);
    window.addToolBar(area, bar);
    return bar;
}

Banners::Banners(QMainWindow &window, DriveControl &drive, Sounds &sounds)
    : QObject(&window)
    , window_(window)
    , note_(named(new Banner, "noticeBanner")) {
    add(new StopBanner(drive, sounds), "stopLine");
    auto *const replay = named(new Banner, "replayBanner");
    add(replay, "replayLine");
    connect(&drive.sessions(), &Sessions::replayChanged, replay, [&drive, replay] {
        const QString &text = drive.sessions().replay();
        replay->tell(text.isEmpty() ? QString() : tr("REPLAY, not the robot of now: %1").arg(text),
                     "background: #6a2fb0; color: white;");
    });
    add(note_, "noticeLine");
    noticed_.setSingleShot(true);
    connect(&noticed_, &QTimer::timeout, note_, [this] { note_->tell({}, {}); });
}

void Banners::add(Banner *banner, const char *name) {
    window_.addToolBarBreak(Qt::BottomToolBarArea);
    QToolBar *const bar = addFixedBar(window_, Qt::BottomToolBarArea, tr("Notice"), name, banner);
    bar->hide();
    all_.emplace_back(banner, bar);
    connect(banner, &Banner::shown, bar, &QToolBar::setVisible);
}

void Banners::notify(const QString &problem) {
    if (problem.isEmpty())
        return;
    qWarning("hermes-gui: %s", qPrintable(problem));
    note_->tell(problem, "background: #8a6100; color: white;");
    noticed_.start(noticeTime);
}

void Banners::show() {
    for (const auto &[banner, bar] : all_)
        bar->setVisible(!banner->text().isEmpty());
}

} // namespace hermes::desktop
