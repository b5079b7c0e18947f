// The body, or the rope, cloth or solid, that was clicked, in numbers and in words.
import { Moon, MousePointerClick, Sun, Trash2, Video } from 'lucide-preact';
import type { JSX } from 'preact';
import { fixed, short } from '../format';
import type { BodyReport, SoftReport } from '../protocol';
import * as store from '../state/store';
import type { Viewer } from '../viewer';
import { Row, Section } from './parts';

const TYPES = { fixed: 'Fixed', kinematic: 'Kinematic', dynamic: 'Dynamic' } as const;

export function InspectPanel({ viewer }: { viewer: Viewer }): JSX.Element {
  const report = store.report.value;
  if (!report) {
    return (
      <div class="empty">
        <MousePointerClick size={28} />
        <p>Click a body to see its mass, its motion, and why it is awake.</p>
        <p class="hint">Drag it to pull it, double-click it to follow it.</p>
      </div>
    );
  }
  return 'kind' in report ? <OnSoft report={report} viewer={viewer} /> : <Report report={report} viewer={viewer} />;
}

const KINDS = { rope: 'Rope', cloth: 'Cloth', solid: 'Solid' } as const;

function OnSoft({ report, viewer }: { report: SoftReport; viewer: Viewer }): JSX.Element {
  const { state } = report;
  return (
    <>
      <div class="body-head">
        <h2>{report.name}</h2>
        <span class="badge">{KINDS[report.kind]}</span>
      </div>
      {store.scene.value?.live && (
        <div class="body-actions">
          <button type="button" class="danger" onClick={() => viewer.playback.command({ do: 'remove_soft', key: report.key })}>
            <Trash2 size={15} /> Remove
          </button>
        </div>
      )}
      <Section title="Matter">
        <dl>
          <Row name="Vertices">{report.vertices.toLocaleString('en')}</Row>
          {report.triangles > 0 && <Row name="Triangles of the surface">{report.triangles.toLocaleString('en')}</Row>}
          {state && (
            <>
              <Row name="Mass">{short(state.mass)} kg</Row>
              <Row name="Kinetic energy">{short(state.kinetic)} J</Row>
              <Row name="Elastic energy">{short(state.elastic)} J</Row>
              <Row name="Vertices in contact">{state.contacts.toLocaleString('en')}</Row>
            </>
          )}
        </dl>
      </Section>
    </>
  );
}

function Report({ report, viewer }: { report: BodyReport; viewer: Viewer }): JSX.Element {
  const live = store.scene.value?.live ?? false;
  const moving = store.scene.value?.posesOnly === '';
  const dynamic = report.type === 'dynamic';
  return (
    <>
      <div class="body-head">
        <h2>{report.name}</h2>
        <span class={`badge ${report.awake ? 'awake' : ''}`}>{dynamic ? (report.awake ? 'awake' : 'asleep') : TYPES[report.type]}</span>
      </div>
      {report.words && <p class="words">{report.words}</p>}
      <div class="body-actions">
        <button type="button" aria-pressed={store.following.value} onClick={() => (store.following.value = !store.following.value)}>
          <Video size={15} /> Follow
        </button>
        {live && dynamic && (
          <button type="button" onClick={() => viewer.playback.command({ do: 'wake', key: report.key, awake: !report.awake })}>
            {report.awake ? <Moon size={15} /> : <Sun size={15} />} {report.awake ? 'Put to sleep' : 'Wake'}
          </button>
        )}
        {live && (
          <button type="button" class="danger" onClick={() => viewer.playback.command({ do: 'remove', key: report.key })}>
            <Trash2 size={15} /> Remove
          </button>
        )}
      </div>
      {report.mass > 0 && (
        <Section title="Mass">
          <dl>
            <Row name="Mass">{short(report.mass)} kg</Row>
            <Row name="Principal moments">{report.principalMoments.map(short).join(' · ')} kg m²</Row>
            <Row name="Centre of mass">{vector(report.centerOfMass, 3)} m</Row>
          </dl>
        </Section>
      )}
      <Section title="Motion">
        <dl>
          <Row name="Position">{vector(report.position, 3)} m</Row>
          <Row name="Orientation">{report.rotation.map((value) => fixed(value, 3)).join('  ')}</Row>
          {moving && (
            <>
              <Row name="Velocity">{vector(report.linear, 3)} m/s</Row>
              <Row name="Speed">{short(Math.hypot(...report.linear))} m/s</Row>
              <Row name="Angular velocity">{vector(report.angular, 3)} rad/s</Row>
            </>
          )}
          {report.mass > 0 && <Row name="Kinetic energy">{short(report.kinetic)} J</Row>}
        </dl>
      </Section>
    </>
  );
}

function vector(values: readonly number[], digits: number): string {
  return values.map((value) => fixed(value, digits)).join('  ');
}
