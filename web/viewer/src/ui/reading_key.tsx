// The key of the colours of soft matter, when stress or strain is shown.
import type { JSX } from 'preact';
import { readingText } from '../format';
import * as store from '../state/store';

export function ReadingKey(): JSX.Element | null {
  const key = store.readingKey.value;
  if (!key) return null;
  return (
    <div class="reading-key" role="img" aria-label={`${key.what} from ${readingText(key.low, key.what)} to ${readingText(key.high, key.what)}`}>
      <span>{readingText(key.high, key.what)}</span>
      <i />
      <span>{readingText(key.low, key.what)}</span>
    </div>
  );
}
