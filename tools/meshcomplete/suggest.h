// "Did you mean ...?"
#pragma once

#include <QString>
#include <QStringList>

namespace meshcomplete {
namespace runner {

/// The candidate nearest to `word` (edits and swaps of neighbours, upper and lower case alike), or nothing
/// when all are too far away to have been meant. Cost: length of `word` times the length of all candidates.
QString nearest(const QString& word, const QStringList& candidates);

/// " Did you mean "X"?" or nothing, to be put behind a message.
QString did_you_mean(const QString& word, const QStringList& candidates);

}  // namespace runner
}  // namespace meshcomplete
