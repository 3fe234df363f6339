#pragma once

#include "gui/desktop/model/Freshness.h"
#include "gui/desktop/widgets/PlainLabel.h"

#include <QTimer>

namespace hermes::desktop {

/// A label for what a robot tells again and again: grey when it is old, struck out when it is silent, and
/// then it says for how long, unless another label does.
class AgedLabel : public PlainLabel {
    Q_OBJECT
public:
    explicit AgedLabel(QWidget *parent = nullptr);

    /// A value, and how old it is.
    void tell(const QString &value, const Freshness &freshness);
    /// One that does not age, or none.
    void tell(const QString &value) { tell(value, {}); }
    /// The time without data stands there, in place of its text.
    void setSilenceLabel(PlainLabel *label);

private:
    void refresh();

    QString value_;
    Freshness freshness_;
    QTimer timer_;
    PlainLabel *silence_ = nullptr;
    QString silenceText_; ///< of that label while there are data
};

} // namespace hermes::desktop
