#include "gui/desktop/widgets/AgedLabel.h"

namespace hermes::desktop {

AgedLabel::AgedLabel(QWidget *parent)
    : PlainLabel({}, parent) {
    timer_.setInterval(100);
    connect(&timer_, &QTimer::timeout, this, &AgedLabel::refresh);
}

void AgedLabel::tell(const QString &value, const Freshness &freshness) {
    value_ = value;
    freshness_ = freshness;
    if (freshness_.state() == Freshness::State::None)
        timer_.stop();
    else if (!timer_.isActive())
        timer_.start();
    refresh();
}

void AgedLabel::setSilenceLabel(PlainLabel *label) {
    silence_ = label;
    silenceText_ = label->text();
}

void AgedLabel::refresh() {
    const bool isLive = freshness_.state() == Freshness::State::None || freshness_.isFresh();
    setEnabled(isLive); // grey
    const bool isSilent = freshness_.state() == Freshness::State::Silent;
    if (font().strikeOut() != isSilent) {
        QFont changed = font();
        changed.setStrikeOut(isSilent);
        setFont(changed);
    }
    if (silence_)
        silence_->setText(isSilent ? freshness_.text() : silenceText_);
    setText(isSilent && !silence_ ? value_ + " (" + freshness_.text() + ')' : value_);
}

} // namespace hermes::desktop
