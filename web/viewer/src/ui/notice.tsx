// What went wrong, in words, on the page.
import { TriangleAlert } from 'lucide-preact';
import type { JSX } from 'preact';
import * as store from '../state/store';

export function NoticeCard(): JSX.Element | null {
  const notice = store.notice.value;
  if (!notice) return null;
  return (
    <div class="veil">
      <div class="bar card" role="alertdialog" aria-labelledby="notice-title" aria-describedby="notice-text">
        <TriangleAlert size={26} class="card-icon" />
        <h2 id="notice-title">{notice.title}</h2>
        <p id="notice-text">{notice.text}</p>
        <div class="card-actions">
          <button
            type="button"
            onClick={() => {
              store.notice.value = null;
              store.scenesOpen.value = true;
            }}
          >
            Choose a scene
          </button>
          {!notice.fatal && (
            <button type="button" class="primary" onClick={() => (store.notice.value = null)}>
              Close
            </button>
          )}
        </div>
      </div>
    </div>
  );
}
