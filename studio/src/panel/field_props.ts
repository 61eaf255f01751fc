// The properties that the fields of all types of members have.
import type { Member } from "../model/classes.ts";
import type { Component, MemberState } from "../model/protocol.ts";

export interface FieldProps {
  component: Component;
  member: Member;
  state: MemberState;
  /** The identifier of the control, which its label names. */
  id: string;
}
