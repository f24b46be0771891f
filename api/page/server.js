// Requests to the server; a problem+json answer becomes an Error with its fields.

export class Problem extends Error {
  constructor(body, status) {
    super(body.detail || body.title || `HTTP ${status}`);
    Object.assign(this, { status, title: body.title, errors: body.errors || [], remedy: body.remedy });
  }
}

async function request(method, path, body) {
  const options = { method, headers: { Accept: "application/json" }, credentials: "same-origin" };
  if (body !== undefined) {
    options.body = JSON.stringify(body);
    options.headers["Content-Type"] = "application/json";
  }
  let answer;
  try {
    answer = await fetch(path, options);
  } catch {
    throw new Problem({ title: "The server does not answer", detail: "The server does not answer. Is `stand serve` still running?" }, 0);
  }
  const content = answer.status === 204 ? null : await answer.json().catch(() => ({ title: answer.statusText }));
  if (!answer.ok) throw new Problem(content, answer.status);
  return content;
}

export const get = (path) => request("GET", path);
export const post = (path, body = {}) => request("POST", path, body);
