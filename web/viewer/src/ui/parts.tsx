// Small pieces that panels are made of.
import type { ComponentChildren, JSX } from 'preact';
import { signal } from '@preact/signals';

export function IconButton(props: {
  label: string;
  shortcut?: string;
  pressed?: boolean;
  disabled?: boolean;
  className?: string;
  onClick: () => void;
  children: ComponentChildren;
}): JSX.Element {
  const { label, shortcut, pressed, disabled, className = '', onClick, children } = props;
  return (
    <button
      type="button"
      class={`icon-button ${className}`}
      aria-label={label}
      title={shortcut ? `${label} (${shortcut})` : label}
      {...(pressed === undefined ? {} : { 'aria-pressed': pressed })}
      disabled={disabled ?? false}
      onClick={onClick}
    >
      {children}
    </button>
  );
}

export function Switch(props: { label: string; hint?: string; shortcut?: string; on: boolean; disabled?: boolean; onChange: (on: boolean) => void }): JSX.Element {
  const { label, hint, shortcut, on, disabled, onChange } = props;
  return (
    <label class={`switch-row ${disabled ? 'disabled' : ''}`}>
      <span class="switch-words">
        <span class="switch-label">{label}</span>
        {hint && <span class="hint">{hint}</span>}
      </span>
      {shortcut && <kbd>{shortcut}</kbd>}
      <input type="checkbox" role="switch" checked={on} disabled={disabled ?? false} onChange={(event) => onChange(event.currentTarget.checked)} />
    </label>
  );
}

export function Slider(props: {
  label: string;
  value: number;
  low: number;
  high: number;
  step: number;
  text: string;
  onInput: (value: number) => void;
}): JSX.Element {
  const { label, value, low, high, step, text, onInput } = props;
  const part = ((value - low) / (high - low)) * 100;
  return (
    <label class="slider-row">
      <span class="slider-head">
        <span>{label}</span>
        <output>{text}</output>
      </span>
      <input
        type="range"
        aria-label={label}
        aria-valuetext={text}
        min={low}
        max={high}
        step={step}
        value={value}
        style={{ '--part': `${part}%` }}
        onInput={(event) => onInput(event.currentTarget.valueAsNumber)}
      />
    </label>
  );
}

export function Choice<T extends string | number>(props: {
  label: string;
  value: T;
  options: readonly { value: T; text: string }[];
  disabled?: boolean;
  onChange: (value: T) => void;
}): JSX.Element {
  const { label, value, options, disabled, onChange } = props;
  return (
    <label class="choice-row">
      <span>{label}</span>
      <select
        value={String(value)}
        disabled={disabled ?? false}
        onChange={(event) => onChange(options[event.currentTarget.selectedIndex]!.value)}
      >
        {options.map((option) => (
          <option key={option.value} value={String(option.value)}>
            {option.text}
          </option>
        ))}
      </select>
    </label>
  );
}

export function Segments<T extends string>(props: { label: string; value: T; options: readonly { value: T; text: string }[]; onChange: (value: T) => void }): JSX.Element {
  return (
    <div class="segments" role="radiogroup" aria-label={props.label}>
      {props.options.map((option) => (
        <button
          key={option.value}
          type="button"
          role="radio"
          aria-checked={option.value === props.value}
          onClick={() => props.onChange(option.value)}
        >
          {option.text}
        </button>
      ))}
    </div>
  );
}

export function Section(props: { title: string; children: ComponentChildren; note?: string }): JSX.Element {
  return (
    <section class="section">
      <h3>{props.title}</h3>
      {props.children}
      {props.note && <p class="hint">{props.note}</p>}
    </section>
  );
}

export function Row(props: { name: string; children: ComponentChildren }): JSX.Element {
  return (
    <div class="row">
      <dt>{props.name}</dt>
      <dd>{props.children}</dd>
    </div>
  );
}

// A message at the foot of the page that goes by itself.
export const toast = signal<string | null>(null);
let toastTimer = 0;
export function say(text: string): void {
  toast.value = text;
  clearTimeout(toastTimer);
  toastTimer = window.setTimeout(() => (toast.value = null), 2200);
}
