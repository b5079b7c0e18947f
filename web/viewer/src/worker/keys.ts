// Keys: how the page names bodies. An id of the engine is a slot, its generation and the number of its world; a world that is made
// from a snapshot has another number but the same slots and generations, so keys stand for those two.
import type { BodyId } from 'gyre-physics';

const WORLD = 2 ** 48; // ids are slot + 2^32 (generation + 2^16 world)

export const placeOf = (id: number): number => id % WORLD;
export const slotOf = (id: number): number => id % 2 ** 32;
export const worldPart = (id: number): number => id - placeOf(id);

export class Keys {
  private readonly keyOfPlace = new Map<number, number>();
  private readonly placeOfKey = new Map<number, number>();
  private next = 0;

  key(id: BodyId): number {
    const place = placeOf(id);
    let key = this.keyOfPlace.get(place);
    if (key === undefined) {
      key = this.next++;
      this.keyOfPlace.set(place, key);
      this.placeOfKey.set(key, place);
    }
    return key;
  }

  // The id of a key in a world; 0, the null id, if it never was one.
  id(key: number, world: number): BodyId {
    const place = this.placeOfKey.get(key);
    return place === undefined ? 0 : place + world;
  }

  has(key: number): boolean {
    return this.placeOfKey.has(key);
  }

  // Forgets all but these: a future that was cut off may give its slots to others.
  keepOnly(ids: Iterable<BodyId>): void {
    const kept = new Set<number>();
    for (const id of ids) kept.add(placeOf(id));
    for (const [place, key] of this.keyOfPlace) {
      if (kept.has(place)) continue;
      this.keyOfPlace.delete(place);
      this.placeOfKey.delete(key);
    }
  }
}
