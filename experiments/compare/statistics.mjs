// Ratios of paired timings, judged without a model of their noise: by their order.

export const median = (values) => {
  const sorted = values.toSorted((a, b) => a - b);
  const middle = sorted.length >> 1;
  return sorted.length % 2 === 1
    ? sorted[middle]
    : (sorted[middle - 1] + sorted[middle]) / 2;
};

/// Which order statistic (from 0) and its mirror enclose the median with at least this
/// confidence, whatever the distribution: each value is above it with probability 1/2.
/// -1: there are too few values.
function rank(n, confidence) {
  // Twice the probability that at most k of n fair coins show heads, term by term; its
  // logarithm, for 2^-n may be too small for a number.
  let log_term = (1 - n) * Math.LN2,
    sum = Math.exp(log_term),
    k = -1;
  while (sum <= 1 - confidence && k < n) {
    ++k;
    log_term += Math.log((n - k) / (k + 1));
    sum += Math.exp(log_term);
  }
  return k;
}

/// The fewest values of which an interval of this confidence can be had.
export function fewest(confidence) {
  let n = 1;
  while (rank(n, confidence) < 0) ++n;
  return n;
}

/// Median and its interval; without one, where there are too few values, [0, Infinity].
export function spread(values, confidence) {
  const sorted = values.toSorted((a, b) => a - b);
  const k = rank(sorted.length, confidence);
  return {
    ratio: median(sorted),
    low: k < 0 ? 0 : sorted[k],
    high: k < 0 ? Infinity : sorted[sorted.length - 1 - k],
  };
}

/// Slower or faster: by more than the threshold (1.05: by 5 %), and its interval leaves
/// out 1.
export function verdict({ ratio, low, high }, threshold) {
  if (ratio > threshold && low > 1) return 'slower';
  if (ratio < 1 / threshold && high < 1) return 'faster';
  return 'same';
}
