#include "gui/desktop/EventBar.h"

#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/ForeignText.h"
#include "gui/desktop/widgets/PlainLabel.h"
#include "gui/desktop/widgets/Quantities.h"

#include <QPushButton>
#include <algorithm>

namespace hermes::desktop {
namespace {

/// What went on for a time, and does not any more.
bool isPast(const Event &event) {
    return event.isOver && !event.key.isEmpty();
}

QString line(const Event &event) {
    const QString time = timeOf(event.stamp).value_or(QDateTime()).toString("HH:mm:ss") + "  ";
    const QString text = event.from + ": " + event.text;
    return time + (isPast(event) ? EventBar::tr("OVER after %1: %2")
                                       .arg(durationText(std::max(1.0, event.over - event.began)), text)
                                 : text);
}

/// Loud while it goes on.
QString styleOf(const Event &event) {
    const bool isError = event.level == Event::Level::Error;
    const char *const colours =
        isPast(event) ? isError ? "background: #7d4a48; color: white;" : "background: #6f6146; color: white;"
        : isError     ? "background: #d0100c; color: white;"
                      : "background: #f0a000; color: black;";
    return QString(colours) + " font-weight: bold;";
}

} // namespace

EventBar::EventBar(Events &events, const Sounds &sounds, QWidget *parent)
    : QWidget(parent)
    , events_(events)
    , sounds_(sounds)
    , text_(named(new PlainLabel, "eventText"))
    , others_(named(new PlainLabel, "otherEvents", tr("So many more events wait to be acknowledged")))
    , acknowledge_(named(new QPushButton(tr("Acknowled&ge")), "acknowledge",
                         tr("I have seen this event; the next one that waits is shown"))) {
    setObjectName("eventLine");
    text_->letElide(Qt::ElideMiddle);
    text_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    text_->setMargin(4);
    auto *const list = named(new QPushButton(tr("Events")), "eventList", tr("All events (Ctrl+9)"));
    setLayout(inRow({{text_, 1}, others_, acknowledge_, list}));
    layout()->setContentsMargins(4, 0, 4, 0);

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
    QString text = tr("No events"), style;
    if (loudest) {
        text = line(*loudest);
        style = styleOf(*loudest);
    } else if (!events_.all().empty()) {
        text = line(events_.all().back());
    }
    others_->setText(others > 0 ? tr("%1 more").arg(others) : QString());
    shown_ = loudest ? loudest->id : 0;
    text_->setText(text);
    text_->setToolTip(toolTipOf(text));
    if (style != text_->styleSheet())
        text_->setStyleSheet(style);
    acknowledge_->setEnabled(loudest);
}

} // namespace hermes::desktop
