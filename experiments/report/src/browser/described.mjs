// One picture with one description for who cannot see it: its thousands of marks are not
// read out one by one, the tables hold their numbers.
export function describe_picture(place, description) {
  const svg = place.querySelector('svg');
  svg.setAttribute('role', 'img');
  svg.setAttribute('aria-label', description);
  for (const part of svg.children) part.setAttribute('aria-hidden', 'true');
}
