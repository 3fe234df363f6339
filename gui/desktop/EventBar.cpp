#include "gui/desktop/EventBar.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/ForeignText.h"
#include "gui/desktop/widgets/PlainLabel.h"

#include <QHBoxLayout>
#include <QPushButton>

namespace hermes::desktop {
namespace {

QString line(const Event &event) {
    const QString time = timeOf(event.stamp).value_or(QDateTime()).toString("HH:mm:ss");
    return time + "  " + event.from + ": " + event.text;
}

} // namespace

EventBar::EventBar(Events &events, const Sounds &sounds, QWidget *parent)
    : QWidget(parent)
    , events_(events)
    , sounds_(sounds)
    , text_(new PlainLabel)
    , acknowledge_(new QPushButton(tr("Acknowled&ge"))) {
    setObjectName("eventLine");
    setBackgroundRole(QPalette::Window); // a tool bar's is that of buttons
    text_->setObjectName("eventText");
    text_->letElide();
    text_->setAutoFillBackground(true);
    text_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
    text_->setMargin(4);
    acknowledge_->setObjectName("acknowledge");
    acknowledge_->setToolTip(tr("I have seen this event; the next one that waits is shown"));
    auto *const list = new QPushButton(tr("Events"));
    list->setObjectName("eventList");
    list->setToolTip(tr("All events (Ctrl+9)"));
    auto *const layout = new QHBoxLayout(this);
    layout->setContentsMargins(4, 0, 4, 0);
    layout->addWidget(text_, 1);
    layout->addWidget(acknowledge_);
    layout->addWidget(list);

    quiet_.setSingleShot(true);
    connect(acknowledge_, &QPushButton::clicked, this, [this] { events_.acknowledge(shown_); });
    connect(list, &QPushButton::clicked, this, &EventBar::listWanted);
    connect(&events, &Events::alarm, this, [this] {
        if (quiet_.isActive())
            return;
        sounds_.beep();
        quiet_.start(std::chrono::seconds(2));
    });
    connect(&events, &Events::changed, &refresh_, [this] {
        if (!refresh_.isActive() || refresh_.remainingTime() > 100)
            refresh_.start(100);
    });
    connect(&refresh_, &QTimer::timeout, this, &EventBar::update);
    update();
}

void EventBar::update() {
    refresh_.start(std::chrono::seconds(1)); // warnings go by themselves
    const Event *const loudest = events_.loudest();
    const int others = events_.waiting() - 1;
    QString text = tr("No events");
    QPalette colours = palette();
    colours.setColor(QPalette::WindowText, theme::colour(Condition::Unreachable));
    if (loudest) {
        text = line(*loudest);
        if (others > 0)
            text = tr("%1    (%2 more)").arg(text).arg(others);
        const bool isError = loudest->level == Event::Level::Error;
        colours.setColor(QPalette::Window, isError ? QColor(0xd0, 0x10, 0x0c) : QColor(0xf0, 0xa0, 0x00));
        colours.setColor(QPalette::WindowText, isError ? Qt::white : Qt::black);
    } else if (!events_.all().empty()) {
        text = line(events_.all().back());
    }
    shown_ = loudest ? loudest->id : 0;
    text_->setText(text);
    text_->setBold(loudest);
    if (colours != text_->palette())
        text_->setPalette(colours);
    acknowledge_->setEnabled(loudest);
}

} // namespace hermes::desktop
